#pragma once
// How far the normal of a patch turns over a triangle of its mesh, proven from its control net.
//
// Along a path of parameters the unit normal n = N / |N| moves by at most the integral of |n_u| |du| + |n_v| |dv|, and
// |n_u| = |N_u x n| / |N|. So over a box h x k any two normals are within h max |n_u| + k max |n_v| radians; and so is, from each
// of them, any normalised mean of others, as long as that is below pi / 2: cones are convex.

#include <array>

#include "tess/write/patch_triangles.h"
#include "tessera/bezier_patch.h"

namespace tessera::inline abi_0_1 {

/// Bounds that hold over a rectangle of the patch, in radians over its own parameters.
struct Turning {
  double u = 0, v = 0;

  /// By rates; a float parameter lies up to 2^-25 beside i / rate, and a float normal beside the surface's.
  double angle(Rates rates) const { return (1.0 / rates.u + 0x1p-24) * u + (1.0 / rates.v + 0x1p-24) * v + 0x1p-21; }
};

/// Bounds for the whole patch, its halves and its quarters, as ChordBound has them. From the net of the normal, cut into
/// pieces until the cones of the normals there tell enough.
class TurningBound {
 public:
  explicit TurningBound(const BezierPatch& patch);
  TurningBound() = default;  ///< of a plane

  /// False where the normal vanishes, or may: at cusps, and where edges that are no points have parallel tangents; and
  /// where it turns by more than 32 radians over a unit of a parameter, nearly a cusp.
  bool is_finite() const;
  /// The largest angle between normals of the surface, or means of them, within a triangle of a mesh at these rates: as in
  /// ChordBound::distance().
  double angle(Rates rates) const;
  /// The smallest real rate along the other parameter that keeps the angle, `fixed` being that along u or v; among even
  /// rates, or odd ones. Infinite if there is none.
  double needed(double angle, int fixed, bool fixed_u, bool even) const;

 private:
  std::array<Turning, 4> quarters_;  // 2 (u > 1/2) + (v > 1/2)
};

}  // namespace tessera::inline abi_0_1
