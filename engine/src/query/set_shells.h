#pragma once
// The shells of a set: which of its patches hang together, and the borders and edges that nothing joins.

#include <cstddef>

#include "ray/border/adjacency.h"
#include "ray/line/set_view.h"

namespace tessera { inline namespace abi_0_1 {

struct SetShells {
  /// Edges with an odd number of coedges; of surfaces that name no edges, the borders of patches that no other has, and
  /// one for each patch that loops cut.
  std::size_t open_borders = 0;
  std::size_t count = 0;  ///< parts that hang together by edges and borders
};
SetShells find_shells(const SetView& set, const Adjacency& borders);

}}  // namespace tessera::abi_0_1
