#pragma once
// All that planning finds out about a set before the tolerance is known.

#include "tess/plan/borders.h"
#include "tess/plan/cut_faces.h"
#include "tess/plan/patch_needs.h"

namespace tessera { inline namespace abi_0_1 {

/// The facts that every plan of a set starts from. The set must outlive them.
struct PlanFacts {
  PatchNeeds needs;  ///< what each patch needs by itself
  CutFaces faces;    ///< what loops cut, and where they run along edges of shapes
  Borders borders;   ///< what neighbours agree on
};

/// Finds the facts of a set. Errors: cancelled, out_of_memory.
Result<PlanFacts> find_plan_facts(const PatchSet::Impl& set, const PlannerOptions& options, const Execution& execution);

}}  // namespace tessera::abi_0_1
