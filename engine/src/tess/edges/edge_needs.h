#pragma once
// Collects the rates that the patches at an edge need there.

#include <algorithm>
#include <cstdint>

#include "tess/cells/segments.h"
#include "tess/edges/shared_edges.h"

namespace tessera::inline abi_0_1 {

constexpr Segments along(PatchSegments patch, Side side) { return runs_along_u(side) ? patch.u : patch.v; }

/// The needs of patches with uniform segments.
struct EdgeNeeds {
  std::uint16_t most = 1;  ///< the largest rate of the patches
  /// 1: the edge's rate must be even, for a patch whose triangles must not cross the middle.
  std::uint16_t is_even = 0;

  /// `never`: 1 for a patch none of whose triangles may cross the middle.
  void add(Segments along, std::uint16_t never) {
    most = std::max(most, static_cast<std::uint16_t>(along.rate()));
    is_even = static_cast<std::uint16_t>(is_even | (never & along.parts_halves()));
  }
  Segments segments() const { return most + (most & is_even); }
};

/// The largest rates in the halves of an edge, in the direction of its first border.
struct HalfNeeds {
  std::uint16_t lower = 1, upper = 1;

  void add(Segments along, bool against) {
    if (against) along = along.reversed();
    lower = std::max(lower, static_cast<std::uint16_t>(along.lower_rate()));
    upper = std::max(upper, static_cast<std::uint16_t>(along.upper_rate()));
  }
  Segments segments(bool against, std::uint16_t is_even) const {
    if (lower == upper) return EdgeNeeds{lower, is_even}.segments();
    const Segments along = Segments::halves((lower + 1) / 2, (upper + 1) / 2);
    return against ? along.reversed() : along;
  }
};

}  // namespace tessera::inline abi_0_1
