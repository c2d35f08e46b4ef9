// Borders, patch-contiguous results, blends. One unit per instruction set: see cmake/TesseraIsaFlags.cmake.

#include "kernel/isa/lanes.h"
#include "kernel/grid/line_kernels.h"

namespace tessera { inline namespace abi_0_1 { namespace kernel { namespace TESSERA_ISA_NAMESPACE {
namespace {

#include "kernel/grid/line_kernel.inl.h"
#include "kernel/sample/border_kernel.inl.h"
#include "kernel/grid/blend_kernel.inl.h"

}  // namespace

extern const LineKernels line_kernels = {
    evaluate_border<Lanes<float>>, begin_lines<Lanes<float>>, begin_lines<Lanes<double>>,
    put_lines<Lanes<float>>,       put_lines<Lanes<double>>,  end_lines<Lanes<float>>,
    end_lines<Lanes<double>>,      blend<Lanes<float>>,       blend<Lanes<double>>,
};

}}}}  // namespace tessera::abi_0_1::kernel::TESSERA_ISA_NAMESPACE
