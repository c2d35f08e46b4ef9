#pragma once
// Finds the segments of a patch that keep several tolerances at once.

#include <optional>

#include "tess/bounds/chord_bound.h"
#include "tess/bounds/turning_bound.h"

namespace tessera { inline namespace abi_0_1 {

/// The limits that the triangles of one patch must keep. A bound that is null has no limit.
struct CellLimits {
  const ChordBound* chord = nullptr;
  double distance = 0;
  const TurningBound* turning = nullptr;
  double angle = 0;
  const ChordBound* picture = nullptr;  ///< the patch in a camera's picture
  double pixels = 0;

  /// Whether there are limits that hold only for halves of the patch, so that triangles must not cross the middle where
  /// segments do not. The limit of an angle holds wherever triangles lie.
  bool is_for_halves() const { return chord || picture; }
  bool is_for_more_than_distance() const { return turning || picture; }
  bool keeps(PatchSegments segments) const;
};

/// Returns the rates of uniform segments that keep the limits with about the fewest cells; empty if none up to `most`
/// do.
std::optional<Rates> cheapest(const CellLimits& limits, int most);

}}  // namespace tessera::abi_0_1
