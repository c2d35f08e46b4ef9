// Exact rays. One unit per instruction set: see cmake/TesseraIsaFlags.cmake.

#include <bit>
#include <limits>

#include "kernel/isa/four_floats.h"
#include "kernel/ray/ray_kernels.h"

namespace tessera { inline namespace abi_0_1 { namespace kernel { namespace TESSERA_ISA_NAMESPACE {
namespace {

#include "kernel/ray/cubic_point.inl.h"
#include "kernel/ray/nearest_kernel.inl.h"
#include "kernel/ray/ray_kernel.inl.h"
#include "kernel/ray/tree_kernel.inl.h"
#if defined(__FMA__) || defined(__aarch64__)
#include "kernel/ray/ray_line_kernel.inl.h"
#include "kernel/ray/ray_packet_kernel.inl.h"
#include "kernel/ray/ray_polish_kernel.inl.h"
#include "kernel/ray/tree_packet_kernel.inl.h"
constexpr RayPacketKernels packet_kernels{ray_lines,           trace_packet<false>, trace_packet<true>,
                                          polish_roots<false>, polish_roots<true>,  next_packet_leaf};
constexpr const RayPacketKernels* packets = &packet_kernels;
#else
constexpr const RayPacketKernels* packets = nullptr;
#endif

}  // namespace

extern const RayKernels ray_kernels = {
    packets,
    trace_polynomial_leaf,
    trace_rational_leaf,
    cubic_point,
    low_rational_point,
    {node_squares, block_squares, cubic_second_order, low_rational_second_order, half_square},
    next_leaf,
};

}}}}  // namespace tessera::abi_0_1::kernel::TESSERA_ISA_NAMESPACE
