#pragma once
// What the patches that meet at an edge need of it.

#include <algorithm>
#include <cstdint>

#include "tess/edges/shared_edges.h"
#include "tess/plan/segments.h"

namespace tessera::inline abi_0_1 {

constexpr Segments along(PatchSegments patch, Side side) { return runs_along_u(side) ? patch.u : patch.v; }

/// Where all have uniform segments.
struct EdgeNeeds {
  std::uint16_t most = 1;     ///< of their rates
  std::uint16_t is_even = 0;  ///< the edge's must be, as one of them counts on no triangle straddling the middle

  /// `never`: 1 for patches that count on that.
  void add(Segments along, std::uint16_t never) {
    most = std::max(most, static_cast<std::uint16_t>(along.rate()));
    is_even = static_cast<std::uint16_t>(is_even | (never & along.parts_halves()));
  }
  Segments segments() const { return most + (most & is_even); }
};

/// The most of rates in the halves of an edge, as its first border runs.
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
