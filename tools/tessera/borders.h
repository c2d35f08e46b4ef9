#pragma once
// Borders of patches that lie at the same place.

#include <cstdint>
#include <vector>

#include "tessera/patch_set.h"

namespace tessera::cli {

/// An edge of a patch of a set.
struct Border {
  std::uint32_t patch = 0;
  Edge edge = Edge::u0;
};

/// All borders that are not collapsed, in groups of those with the same ends (within `tolerance`, a length of 1e-9 of the
/// model's size at the least) and about
/// the same middle (within a twentieth of their length), in the order of their first members. O(borders) where few share
/// their ends.
std::vector<std::vector<Border>> group_borders(const PatchSet& set, double tolerance);

}  // namespace tessera::cli
