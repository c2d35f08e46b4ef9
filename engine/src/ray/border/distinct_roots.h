#pragma once
// Reduces the roots of a ray to distinct ones, in order.

#include <vector>

#include "ray/border/adjacency.h"
#include "ray/line/ray_query.h"
#include "ray/line/set_view.h"

namespace tessera { inline namespace abi_0_1 {

/// Sorts by s and drops roots that repeat another: on one patch at the same place, or on two patches at matching places
/// of a shared border, or at a pole, in any chain of such steps (around a vertex or a pole).
///
/// 1. Let a and b be within r_a and r_b of the line, rounding included. Both then lie within r_a + r_b of each other
///    across it.
/// 2. If they stand for one root, their parameters differ by at most 2 |J^-1| (r_a + r_b) as long as the map contracts
///    by 1/2 (reach_u and reach_v in ray_query.h). A part that the search took whole reaches as far as its size.
/// 3. Certified roots are the same only if that makes them so: no uncertified one ever joins two of them. Uncertified
///    ones join each other, and are dropped if one of them may stand for a certified root.
/// 4. Of equal roots the one with the smallest residual is kept.
///
/// Nearness in s proves nothing: roots that are merely near are kept.
void keep_distinct(const SetView& set, const Adjacency& adjacency, std::vector<LeafRoot>& roots);

}}  // namespace tessera::abi_0_1
