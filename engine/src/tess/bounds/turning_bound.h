#pragma once
// Bounds how far the normal of a patch turns over a triangle of its mesh, proven from its control net.
//
// 1. Along a path of parameters the unit normal n = N / |N| moves by at most the integral of |n_u| |du| + |n_v| |dv|,
//    where |n_u| = |N_u x n| / |N|.
// 2. Let t_u and t_v bound |n_u| and |n_v| in each of 8 x 8 rectangles of the parameters, and let p_u and p_v be the
//    rates there (Segments). In the coordinates U = integral of p_u du and V = integral of p_v dv, a triangle that lies
//    between two neighbouring points along u and along v lies in a square of side 1. On the straight line between two
//    points of it, in U and V, the normal moves by at most the mean of t_u / p_u + t_v / p_v over the rectangles on the
//    way.
// 3. So any two normals over the triangle are within the largest t_u / p_u + t_v / p_v of each other. It makes no
//    difference whether a triangle crosses from one rectangle to another.
// 4. Any normalised mean of normals is as near to each of them, as long as the angle is below pi / 2: cones are convex.

#include <array>

#include "tess/cells/segments.h"
#include "tessera/bezier_patch.h"

namespace tessera { inline namespace abi_0_1 {

/// Bounds on |n_u| and |n_v| over a rectangle of the patch, in radians over its own parameters.
struct Turning {
  double u = 0, v = 0;
};

/// Bounds over the 8 x 8 equal rectangles of a patch. They follow from the net of the normal, cut into pieces until the
/// cones of the normals there are narrow enough.
class TurningBound {
 public:
  static constexpr int parts = Segments::parts;

  /// `angle`: the angle to keep. Rectangles over which the normal turns by less share a bound.
  TurningBound(const BezierPatch& patch, double angle);
  TurningBound() = default;  ///< bounds a plane

  /// Whether there is a bound. There is none where the normal vanishes, or may: at cusps, and where edges that are not
  /// points have parallel tangents; nor where it turns by more than 32 radians over a unit of a parameter, nearly a
  /// cusp.
  bool is_finite() const { return is_finite_; }
  /// Whether all rectangles share a bound.
  bool is_even() const;
  /// The bounds, `[u][v]`.
  float u(int i, int j) const { return u_[at(i, j)]; }
  float v(int i, int j) const { return v_[at(i, j)]; }
  /// Returns the part of an angle that float parameters, up to 2^-25 beside the exact ones, and float normals leave.
  double without_rounding(double angle) const;
  /// Returns the largest angle between normals of the surface, or means of them, within a triangle of a mesh.
  double angle(PatchSegments segments) const;

 private:
  friend class TurningSearch;
  static constexpr std::size_t at(int i, int j) { return static_cast<std::size_t>(parts * i + j); }

  std::array<float, parts * parts> u_{}, v_{};
  float largest_ = 0;  ///< the largest sum of a bound along u and one along v, of any two rectangles
  bool is_finite_ = true;
};

}}  // namespace tessera::abi_0_1
