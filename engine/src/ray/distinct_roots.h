#pragma once
// All roots of a ray, in order and each once.

#include <vector>

#include "ray/adjacency.h"
#include "ray/ray_query.h"
#include "ray/set_view.h"

namespace tessera {

/// Sorts by s and drops roots that are another one again: on the same patch within the radii of both, or on two
/// patches at matching places of a shared border, in any chain of such steps (around a vertex or a pole). Of those
/// that are the same a certified one stays, else the one with the smallest residual. Roots that are merely near in s
/// stay.
void keep_distinct(const SetView& set, const Adjacency& adjacency, std::vector<LeafRoot>& roots);

}  // namespace tessera
