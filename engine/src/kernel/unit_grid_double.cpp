// Grids of doubles. One unit an instruction set: see cmake/TesseraIsaFlags.cmake.

#include <utility>

#include "kernel/grid_kernels.h"
#include "kernel/lanes.h"

namespace tessera::kernel::TESSERA_ISA_NAMESPACE {
namespace {

#include "kernel/store.inl.h"
#include "kernel/sample_kernel.inl.h"
#include "kernel/normal_kernel.inl.h"
#include "kernel/curvature_kernel.inl.h"
#include "kernel/line_stores.inl.h"
#include "kernel/grid_kernel.inl.h"

}  // namespace

extern const DoubleGridKernels double_grid_kernels = {
    evaluate_grid<Lanes<double>>,
};

}  // namespace tessera::kernel::TESSERA_ISA_NAMESPACE
