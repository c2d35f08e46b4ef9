#pragma once
// Divides patches so that neighbours have the same points on their common borders.

#include "tess/plan/certified_plan.h"
#include "tess/plan/plan_facts.h"

namespace tessera { inline namespace abi_0_1 {

/// Chooses the segments of all borders from those that the patches need for themselves, one number for all patches that
/// meet there, and fills DividedPatches::divisions, lines and open_edges. Bounds grow where an odd number of segments
/// lies beside an even one.
void divide_patches(const PlanFacts& facts, double tolerance, DividedPatches& patches);

/// Divides borders as above, for `border_tolerance`, and the patches between them for a larger tolerance. Those that
/// cannot keep it between such borders have the segments that choose_rates() found for `border_tolerance`.
void divide_within_borders(const PlanFacts& facts, double tolerance, double border_tolerance, DividedPatches& patches);

}}  // namespace tessera::abi_0_1
