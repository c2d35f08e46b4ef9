// Vertices and triangles of meshes. One unit an instruction set: see cmake/TesseraIsaFlags.cmake.

#include "kernel/lanes.h"
#include "kernel/mesh_kernels.h"

namespace tessera::kernel::TESSERA_ISA_NAMESPACE {
namespace {

#include "kernel/store.inl.h"
#include "kernel/sample_kernel.inl.h"
#include "kernel/normal_kernel.inl.h"
#include "kernel/symmetric_sum.inl.h"
#include "kernel/mesh_kernel.inl.h"
#include "kernel/index_vector.inl.h"
#include "kernel/mesh_index.inl.h"

}  // namespace

extern const MeshKernels mesh_kernels = {
    write_mesh_vertices<Lanes<float>>,
    write_mesh_indices<Lanes<float>>,
};

}  // namespace tessera::kernel::TESSERA_ISA_NAMESPACE
