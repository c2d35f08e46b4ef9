// Positions patch after patch. One unit per instruction set: see cmake/TesseraIsaFlags.cmake.

#include "kernel/isa/block_lanes.h"
#include "kernel/grid/flat_kernels.h"
#include "kernel/isa/lanes.h"
#include "kernel/store/stream_state.h"

namespace tessera { inline namespace abi_0_1 { namespace kernel { namespace TESSERA_ISA_NAMESPACE {
namespace {

#include "kernel/grid/flat_kernel.inl.h"

/// Four rows of three components take twelve lanes; in shorter vectors permutations cost more than blocks do.
template <class L>
constexpr auto flat_kernel() -> Isa (*)(const FlatJob&) {
  if constexpr (L::width == flat_lanes) {
    return evaluate_flat<L>;
  } else {
    return nullptr;
  }
}

}  // namespace

extern const FlatKernels flat_kernels = {flat_kernel<Lanes<float>>()};

}}}}  // namespace tessera::abi_0_1::kernel::TESSERA_ISA_NAMESPACE
