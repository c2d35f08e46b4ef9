// Exact rays. One unit an instruction set: see cmake/TesseraIsaFlags.cmake.

#include "kernel/fours.h"
#include "kernel/ray_kernels.h"

namespace tessera::kernel::TESSERA_ISA_NAMESPACE {
namespace {

#include "kernel/ray_kernel.inl.h"
#include "kernel/cubic_point.inl.h"

}  // namespace

extern const RayKernels ray_kernels = {
    trace_polynomial_leaf,
    trace_rational_leaf,
    cubic_point,
    low_rational_point,
};

}  // namespace tessera::kernel::TESSERA_ISA_NAMESPACE
