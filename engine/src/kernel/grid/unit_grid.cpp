// Grids of floats. One unit per instruction set: see cmake/TesseraIsaFlags.cmake.

#include <utility>

#include "kernel/grid/grid_kernels.h"
#include "kernel/isa/lanes.h"
#include "kernel/grid/line_kernels.h"

namespace tessera { inline namespace abi_0_1 { namespace kernel { namespace TESSERA_ISA_NAMESPACE {
namespace {

#include "kernel/grid/grid_kernel.inl.h"
#include "kernel/grid/line_kernel.inl.h"
#include "kernel/grid/mesh_line_kernel.inl.h"
#include "kernel/grid/record_kernel.inl.h"

/// Vectors of half a line that are streamed one by one go to memory in halves.
template <class L>
constexpr auto mesh_line_kernel() -> Isa (*)(const GridJob<float>&, const LineJob<float>&) {
  if constexpr (L::width == block_lanes) {
    return mesh_lines<L>;
  } else {
    return nullptr;
  }
}

}  // namespace

extern const GridKernels grid_kernels = {
    evaluate_grid<Lanes<float>>,
    mesh_line_kernel<Lanes<float>>(),
    grid_records<Lanes<float>>,
};

}}}}  // namespace tessera::abi_0_1::kernel::TESSERA_ISA_NAMESPACE
