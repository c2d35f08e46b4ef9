#pragma once
// Chooses the segments that each patch needs for itself, and states the bounds that they keep.

#include "tess/plan/certified_plan.h"
#include "tess/plan/plan_facts.h"

namespace tessera { inline namespace abi_0_1 {

/// Fills DividedPatches::segments, bounds, angles, pixels, crosses and beyond. Errors: invalid_argument (no patch keeps
/// the limits), cancelled.
Status choose_rates(const PlanFacts& facts, const PlanRequest& request, DividedPatches& patches,
                    const Execution& execution);

}}  // namespace tessera::abi_0_1
