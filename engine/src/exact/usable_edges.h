#pragma once
// Faces whose loops do not fit their edges.

#include <cstddef>
#include <string>
#include <vector>

#include "tessera/model.h"

namespace tessera { inline namespace abi_0_1 {

struct UnusableEdges {
  std::size_t face = 0;  ///< index into Shape::faces
  std::string reason;    ///< "loop 1: ..."
};

/// Takes its edges from each face whose loops do not fit them, as check_topology() says: one edge must not cost the
/// model. Returns what was taken.
std::vector<UnusableEdges> drop_unusable_edges(Shape& shape);

}}  // namespace tessera::abi_0_1
