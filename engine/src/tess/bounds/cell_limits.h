#pragma once
// Rates that keep several tolerances at once.

#include <optional>

#include "tess/bounds/chord_bound.h"
#include "tess/bounds/turning_bound.h"

namespace tessera::inline abi_0_1 {

/// What the triangles of one patch must keep; what is null is not asked for.
struct CellLimits {
  const ChordBound* chord = nullptr;
  double distance = 0;
  const TurningBound* turning = nullptr;
  double angle = 0;
  const ChordBound* picture = nullptr;  ///< of the patch as a camera sees it
  double pixels = 0;

  bool keeps(Rates rates) const;
  /// The smallest real rate along the other parameter, `fixed` being that along u or v; among even rates, or odd ones.
  double needed(int fixed, bool fixed_u, bool even) const;
};

/// Rates that keep them with about the fewest cells; none up to `most` do: empty.
std::optional<Rates> cheapest(const CellLimits& limits, int most);

}  // namespace tessera::inline abi_0_1
