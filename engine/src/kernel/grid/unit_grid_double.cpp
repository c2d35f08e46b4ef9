// Grids of doubles. One unit per instruction set: see cmake/TesseraIsaFlags.cmake.

#include <utility>

#include "kernel/grid/grid_kernels.h"
#include "kernel/isa/lanes.h"

namespace tessera { inline namespace abi_0_1 { namespace kernel { namespace TESSERA_ISA_NAMESPACE {
namespace {

#include "kernel/grid/grid_kernel.inl.h"

}  // namespace

extern const DoubleGridKernels double_grid_kernels = {
    evaluate_grid<Lanes<double>>,
};

}}}}  // namespace tessera::abi_0_1::kernel::TESSERA_ISA_NAMESPACE
