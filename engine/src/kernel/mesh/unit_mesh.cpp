// Vertices and triangles of meshes. One unit per instruction set: see cmake/TesseraIsaFlags.cmake.

#include "kernel/isa/lanes.h"
#include "kernel/mesh/mesh_kernels.h"

namespace tessera { inline namespace abi_0_1 { namespace kernel { namespace TESSERA_ISA_NAMESPACE {
namespace {

#include "kernel/mesh/mesh_kernel.inl.h"
#if defined(__AVX512F__)
#include "kernel/mesh/mesh_cubic_avx512.inl.h"
#endif
#include "kernel/mesh/mesh_index.inl.h"

template <class L, int Order>
void write_vertices_of_order(const MeshVertexJob& job) {
#if defined(__AVX512F__)
  if (job.points) return CubicVertices<L, Order>(job).write();
#endif
  const bool cubic = job.grid.degree_u == 3 && job.grid.degree_v == 3;
  if (cubic && !job.grid.rational) return PatchVertices<L, 3, false, Order>(job).write();
  if (cubic) return PatchVertices<L, 3, true, Order>(job).write();
  if (job.grid.rational) {
    PatchVertices<L, 0, true, Order>(job).write();
  } else {
    PatchVertices<L, 0, false, Order>(job).write();
  }
}

template <class L>
void write_mesh_vertices(const MeshVertexJob& job) {
  if (job.normal.out[0] || job.normal.lines) {
    write_vertices_of_order<L, 1>(job);
  } else {
    write_vertices_of_order<L, 0>(job);
  }
}

template <class L>
constexpr auto finish_lines_kernel() -> void (*)(StreamState&) {
  if constexpr (has_lines<L>) {
    return [](StreamState& lines) { LineSink<L, true>(lines).finish(); };
  } else {
    return nullptr;
  }
}

}  // namespace

extern const MeshKernels mesh_kernels = {
    write_mesh_vertices<Lanes<float>>,
    write_mesh_indices<Lanes<float>>,
#if defined(__AVX512F__)
    write_mesh_points<Lanes<float>>,
#else
    nullptr,
#endif
    finish_lines_kernel<Lanes<float>>(),
};

}}}}  // namespace tessera::abi_0_1::kernel::TESSERA_ISA_NAMESPACE
