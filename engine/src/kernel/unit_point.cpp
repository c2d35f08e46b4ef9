// Scattered points. One unit an instruction set: see cmake/TesseraIsaFlags.cmake.

#include <utility>

#include "kernel/lanes.h"
#include "kernel/point_kernels.h"

namespace tessera::kernel::TESSERA_ISA_NAMESPACE {
namespace {

#include "kernel/store.inl.h"
#include "kernel/sample_kernel.inl.h"
#include "kernel/normal_kernel.inl.h"
#include "kernel/curvature_kernel.inl.h"
#include "kernel/line_stores.inl.h"
#include "kernel/grid_kernel.inl.h"
#include "kernel/lane_weights.inl.h"
#include "kernel/locate_kernel.inl.h"
#include "kernel/point_slots.inl.h"
#include "kernel/point_kernel.inl.h"
#include "kernel/point_store.inl.h"

}  // namespace

extern const PointKernels point_kernels = {
    evaluate_points<Lanes<float>>, evaluate_points<Lanes<double>>, check_points<float>, check_points<double>, locate,
    store_points<Lanes<float>>,    store_points<Lanes<double>>,
};

}  // namespace tessera::kernel::TESSERA_ISA_NAMESPACE
