#pragma once
// Finds the patches that meet at a border, and measures how smoothly.

#include <cstddef>
#include <optional>

#include "console/report.h"
#include "tessera/bezier_operations.h"
#include "tessera/patch_set.h"

namespace tessera::cli {

/// Tolerances of info: files often hold six digits, and designers call a tenth of a degree smooth.
inline constexpr JoinTolerances join_tolerances{.position = 1e-6, .angle = 2e-3, .derivative = 1e-3};

/// Counts joins by their continuity; maxima are over the measured ones.
struct JoinCounts {
  std::size_t joins = 0, measured = 0;
  std::size_t c1 = 0, g1 = 0, c0 = 0, gaps = 0;  ///< gaps: the borders share their ends, but differ between them
  double largest_angle = 0;                      ///< radians, over joins without a gap
  double largest_gap = 0;                        ///< in the model's unit
};

struct Joins {
  JoinCounts between_surfaces, within_surfaces;
  std::size_t open_borders = 0;     ///< borders of one patch only, without those that are one point
  std::size_t crowded_borders = 0;  ///< where three patches or more meet
};

/// Finds neighbours: borders whose ends lie within 1e-4 of the model's size, and whose middles lie within a twentieth
/// of their length. Measures at most `most` joins, those between surfaces first; joins - measured remain. Uses all
/// threads; the figures are the same for any number of them.
Result<Joins> find_joins(const PatchSet& set, std::size_t most);

/// Adds two or three lines, or that joins are left out.
void add_joins(Report& report, const std::optional<Joins>& joins);

}  // namespace tessera::cli
