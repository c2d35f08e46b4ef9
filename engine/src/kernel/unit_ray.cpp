// Exact rays. One unit an instruction set: see cmake/TesseraIsaFlags.cmake.

#include <limits>

#include "kernel/fours.h"
#include "kernel/ray_kernels.h"

namespace tessera::kernel::TESSERA_ISA_NAMESPACE {
namespace {

#include "kernel/ray_kernel.inl.h"
#include "kernel/cubic_point.inl.h"
#if !defined(__SSE2__) || defined(__FMA__)
#include "kernel/ray_line_kernel.inl.h"
#include "kernel/ray_packet_kernel.inl.h"
constexpr auto lines = ray_lines;
constexpr auto packet = rays_that_touch;
#else
constexpr decltype(RayKernels::lines) lines = nullptr;
constexpr decltype(RayKernels::rays_that_touch) packet = nullptr;  // four at a time are no quicker than each
#endif

}  // namespace

extern const RayKernels ray_kernels = {
    lines,
    packet,
    trace_polynomial_leaf,
    trace_rational_leaf,
    cubic_point,
    low_rational_point,
};

}  // namespace tessera::kernel::TESSERA_ISA_NAMESPACE
