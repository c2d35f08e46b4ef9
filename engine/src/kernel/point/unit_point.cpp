// Scattered points. One unit per instruction set: see cmake/TesseraIsaFlags.cmake.

#include <utility>

#include "kernel/isa/lanes.h"
#include "kernel/point/point_kernels.h"

namespace tessera { inline namespace abi_0_1 { namespace kernel { namespace TESSERA_ISA_NAMESPACE {
namespace {

#include "kernel/grid/grid_kernel.inl.h"
#include "kernel/point/locate_kernel.inl.h"
#include "kernel/point/point_kernel.inl.h"
#include "kernel/point/point_store.inl.h"

}  // namespace

extern const PointKernels point_kernels = {
    evaluate_points<Lanes<float>>, evaluate_points<Lanes<double>>, check_points<float>, check_points<double>, locate,
    store_points<Lanes<float>>,    store_points<Lanes<double>>,
};

}}}}  // namespace tessera::abi_0_1::kernel::TESSERA_ISA_NAMESPACE
