#pragma once
// Bounds how far the normal of a patch turns over a triangle of its mesh, proven from its control net.
//
// 1. Along a path of parameters the unit normal n = N / |N| moves by at most the integral of |n_u| |du| + |n_v| |dv|,
//    where |n_u| = |N_u x n| / |N|.
// 2. So any two normals over a box h x k are within h max |n_u| + k max |n_v| radians of each other.
// 3. Any normalised mean of normals is as near to each of them, as long as the angle is below pi / 2: cones are convex.

#include <array>

#include "tess/cells/patch_triangles.h"
#include "tessera/bezier_patch.h"

namespace tessera::inline abi_0_1 {

/// Bounds on |n_u| and |n_v| over a rectangle of the patch, in radians over its own parameters.
struct Turning {
  double u = 0, v = 0;

  /// Returns the largest angle at these rates. A float parameter lies up to 2^-25 beside i / rate, and a float normal
  /// beside the surface's.
  double angle(Rates rates) const { return (1.0 / rates.u + 0x1p-24) * u + (1.0 / rates.v + 0x1p-24) * v + 0x1p-21; }
};

/// Bounds for the whole patch, its halves and its quarters, as in ChordBound. They follow from the net of the normal,
/// cut into pieces until the cones of the normals there are narrow enough.
class TurningBound {
 public:
  explicit TurningBound(const BezierPatch& patch);
  TurningBound() = default;  ///< bounds a plane

  /// Whether there is a bound. There is none where the normal vanishes, or may: at cusps, and where edges that are not
  /// points have parallel tangents; nor where it turns by more than 32 radians over a unit of a parameter, nearly a
  /// cusp.
  bool is_finite() const;
  /// Returns the largest angle between normals of the surface, or means of them, within a triangle of a mesh at these
  /// rates; conditions as for ChordBound::distance().
  double angle(Rates rates) const;
  /// Returns the smallest real rate along the other parameter that keeps the angle, with the rate `fixed` along u or v;
  /// infinite if there is none. `even`: by the bounds of even rates, else of odd ones.
  double needed(double angle, int fixed, bool fixed_u, bool even) const;

 private:
  std::array<Turning, 4> quarters_;  // 2 (u > 1/2) + (v > 1/2)
};

}  // namespace tessera::inline abi_0_1
