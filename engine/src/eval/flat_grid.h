#pragma once
// Positions patch by patch, by the flat kernel: lanes = numbers of a row (kernel/grid/flat_kernel.inl.h).

#include "block/patch_set_impl.h"
#include "eval/grid_plan_impl.h"

namespace tessera { inline namespace abi_0_1 {

/// Fills plan.flat if the flat kernel can evaluate the plan's grids and is faster: in float, for polynomial patches
/// that share their parameters, with long rows, on an instruction set that has this kernel.
void tabulate_flat(const PatchSet::Impl& set, GridPlan::Impl& plan);

/// Records x y z of all patches from `out` on, for a plan that has flat tables. The same bytes as by blocks.
Status evaluate_flat(const PatchSet::Impl& set, const GridPlan::Impl& plan, float* out, bool streaming,
                     const Execution& execution);

}}  // namespace tessera::abi_0_1
