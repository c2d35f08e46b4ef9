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

/// Bounds from below on the segments that keep the limits of distances.
///
/// Proof: segments with the rates p[i] in the halves of u and q[j] in those of v are at least (p[0] + p[1]) / 2 and
/// (q[0] + q[1]) / 2. In each quarter uu / p^2 + 2 uv / (p q) + vv / q^2 <= 8 distance. So p^2 >= uu / (8 distance),
/// and, by the means of uu / p^2 and vv / q^2, p q >= (sqrt(uu vv) + uv) / (4 distance).
class LeastRates {
 public:
  explicit LeastRates(const CellLimits& limits);
  double u() const { return u_; }  ///< the least number of segments along u
  double v() const { return v_; }
  double cells() const;

 private:
  double u_, v_, products_;  ///< of segments along u and v
};

/// Returns the rates of uniform segments that keep the limits with about the fewest cells; empty if none up to `most`
/// do.
std::optional<Rates> cheapest(const CellLimits& limits, int most);

}}  // namespace tessera::abi_0_1
