#pragma once
// Gives the faces of shapes the same vertices along their edges.

#include "tess/plan/certified_plan.h"
#include "tess/plan/plan_facts.h"

namespace tessera { inline namespace abi_0_1 {

/// Cuts the patches that loops cut, and fills DividedPatches::closed. If none is cut, all must be divided before.
/// Errors: invalid_argument (more triangles than the limit), cancelled.
Status close_faces(const PlanFacts& facts, const PlanRequest& request, DividedPatches& patches,
                   const Execution& execution);

}}  // namespace tessera::abi_0_1
