#pragma once
// Completes the roots of lines that touch a crease or a corner from outside.

#include <vector>

#include "ray/border/adjacency.h"
#include "ray/line/ray_query.h"
#include "ray/line/set_view.h"

namespace tessera { inline namespace abi_0_1 {

/// Adds roots where patches that share a border fold over each other, seen along the line, so that a line crosses a
/// closed body an even number of times. `roots` are distinct (distinct_roots.h), and stay in order.
///
/// 1. A certified root that reaches a border stands for all patches around that point (root_fan.h). By rounding, one of
///    them may be met and its neighbour be missed. That is right where the line passes through, but not where it
///    touches.
/// 2. To decide alike for all of them, let the line move by an infinitely small vector, from the border into the root's
///    patch. It then meets the patches whose corner there, a cone seen along the line, holds that vector.
/// 3. If roots were found of an odd number of patches more or fewer, one of the others is added. It lies on the border
///    and is not certified.
///
/// Does nothing at poles, and where a patch is seen from its edge. `sides`: those of the set's faces. Throws bad_alloc.
void complete_folds(const SetView& set, const Adjacency& borders, const SceneFrame& frame, const RayLine& line,
                    const RootSides& sides, std::vector<LeafRoot>& roots);

}}  // namespace tessera::abi_0_1
