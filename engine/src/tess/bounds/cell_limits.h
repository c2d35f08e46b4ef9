#pragma once
// Finds the rates of a patch that keep several tolerances at once.

#include <optional>

#include "tess/bounds/chord_bound.h"
#include "tess/bounds/turning_bound.h"

namespace tessera::inline abi_0_1 {

/// The limits that the triangles of one patch must keep. A bound that is null has no limit.
struct CellLimits {
  const ChordBound* chord = nullptr;
  double distance = 0;
  const TurningBound* turning = nullptr;
  double angle = 0;
  const ChordBound* picture = nullptr;  ///< the patch in a camera's picture
  double pixels = 0;

  bool keeps(Rates rates) const;
  /// Returns the smallest real rate along the other parameter that keeps all limits, with `fixed` along u or v. `even`:
  /// by the bounds of even rates, else of odd ones.
  double needed(int fixed, bool fixed_u, bool even) const;
};

/// Returns rates that keep the limits with about the fewest cells; empty if none up to `most` do.
std::optional<Rates> cheapest(const CellLimits& limits, int most);

}  // namespace tessera::inline abi_0_1
