#pragma once
// Shapes as the command line meshes them.

#include <algorithm>
#include <cstddef>
#include <vector>

#include "support/synthetic_sets.h"
#include "tessera/edge_matching.h"
#include "tessera/topology.h"

namespace tessera::bench {

/// The shape, with edges joined where some have a single face.
inline Shape joined_shape(const Shape& shape) {
  const EdgeUses uses = test::value_of(edge_uses(shape));
  bool is_open = false;
  for (std::size_t edge = 0; edge < shape.edges.size(); ++edge)
    is_open |= !shape.edges[edge].degenerate && uses[edge].size() == 1;
  const double distance = is_open ? test::value_of(joining_distance(shape)) : 0;
  return distance > 0 ? test::value_of(joined_edges(shape, distance)) : shape;
}

/// Whether all shells of a shape are closed, and there are some.
inline bool is_closed(const Shape& shape) {
  const std::vector<bool> closed = test::value_of(closed_shells(shape));
  return !closed.empty() && std::ranges::find(closed, false) == closed.end();
}

}  // namespace tessera::bench
