#pragma once
// Borders of patches that lie at the same place.

#include <cstdint>
#include <vector>

#include "tessera/patch_set.h"

namespace tessera::cli {

/// A side of a patch of a set.
struct Border {
  std::uint32_t patch = 0;
  Side side = Side::u0;
};

/// Groups all borders that are not collapsed, in the order of the groups' first members. Borders of a group have the
/// same ends (within `tolerance`, at least 1e-9 of the model's size) and about the same middle (within a twentieth of
/// their length). O(borders) if few share their ends.
std::vector<std::vector<Border>> group_borders(const PatchSet& set, double tolerance);

}  // namespace tessera::cli
