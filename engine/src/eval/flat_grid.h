#pragma once
// Positions patch after patch by kernel 3, lanes = numbers of a row (kernel/grid/flat_kernel.inl.h).

#include "block/patch_set_impl.h"
#include "eval/grid_plan_impl.h"

namespace tessera::inline abi_0_1 {

/// Fills plan.flat where the plan's grids can be evaluated so and it pays: floats, polynomial patches, one parameter
/// list for all, long rows, and an instruction set that is made for it.
void tabulate_flat(const PatchSet::Impl& set, GridPlan::Impl& plan);

/// Records x y z of all patches from `out` on, for a plan that has flat tables. The same bytes as by blocks.
Status evaluate_flat(const PatchSet::Impl& set, const GridPlan::Impl& plan, float* out, bool streaming,
                     const Execution& execution);

}  // namespace tessera::inline abi_0_1
