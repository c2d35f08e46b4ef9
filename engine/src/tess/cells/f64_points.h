#pragma once
// Computes vertices in double, from the set's double control points, for tolerances that float sums do not keep.

#include "surface/net/homogeneous.h"
#include "tess/cells/stitched_patch.h"

namespace tessera { inline namespace abi_0_1 {

/// Returns the largest distance between a vertex of F64Points, rounded to float, and the surface's point at the exact
/// parameters. Lengths are those of the model.
///
/// Let V_ij be the control points relative to the origin, S = sum B_i B_j w_ij V_ij / sum B_i B_j w_ij, R = max |V_ij|
/// and u = 2^-53.
///
/// 1. Each term of the sums goes through these roundings: of V_ij, and of its product with w_ij; of B_i, m of the
///    fractions i / n and (n - i) / n, at most m + 1 of their powers, and one of the binomial; of B_j as many, by n; of
///    the products of B_i and B_j with the rest; and m + n of the sums. They are at most 3 (m + n) + 8.
/// 2. So the sum is off, component by component, by a vector of at most
///      g sum B_i B_j w_ij |V_ij|,  g = (3 (m + n) + 8) u
///    (Higham, Accuracy and Stability of Numerical Algorithms, 2nd ed., sec. 3.1). So is the sum of weights, relative
///    to itself.
/// 3. The B_i B_j w_ij over their sum are shares. So the point is off by at most 2 g R and the division's rounding.
/// 4. Rounding to the nearest float changes each component by at most 2^-24 of it. So it moves the vertex by at most
///    2^-24 |S| <= 2^-24 R, or 2^-150 where float underflows.
double f64_vertex_rounding(const BezierPatch& patch, const Vec3& origin);
/// Returns the largest distance between a vertex of F64Points, plus the origin in double, and the surface's point.
/// Instead of the rounding to float, the sum with the origin is off by at most u |P| <= u max |P_ij|, with P_ij the
/// control points.
double f64_position_rounding(const BezierPatch& patch, const Vec3& origin);

/// The vertices of one patch, relative to the set's origin.
///
/// Allocates nothing; the bits are the same on all instruction sets. Points of a border depend only on its own control
/// points, not on the direction in which it runs. Corners, and all points of a collapsed border, are control points.
class F64Points {
 public:
  /// The patch must outlive this object.
  F64Points(const BezierPatch& patch, const Vec3& origin) : patch_(patch), origin_(origin), net_(patch, origin) {}

  /// Calls visit(point) for the inner points of a division, in its order.
  template <class Visit>
  void for_inner(const Division& division, Visit visit) const {
    for (int iu = 1; iu < division.inner.u.rate(); ++iu) {
      const Curve row = row_at(division.inner.u.at(iu));
      for (int iv = 1; iv < division.inner.v.rate(); ++iv) visit(row.at(division.inner.v.at(iv)));
    }
  }
  /// Calls visit(k, point) for the points k = 0 .. rate - 1 of a side, in the direction of the ring.
  template <class Visit>
  void for_border(const Division& division, Side side, Visit visit) const {
    const Segments along = division.border[static_cast<std::size_t>(side)];
    const int rate = along.rate();
    const Vec3 start = start_of(side);
    visit(0, start);
    if (division.collapsed.has(side)) {
      for (int k = 1; k < rate; ++k) visit(k, start);
    } else if (rate > 1) {
      const Curve border = border_along(side);
      for (int k = 1; k < rate; ++k) visit(k, border.at(along.at(is_backward(side) ? rate - k : k)));
    }
  }

 private:
  /// A curve of the net.
  struct Curve {
    int degree;
    double scale;  ///< from the net's numbers to the model's lengths
    std::array<Homogeneous, max_degree + 1> points;

    Vec3 at(Segments::Fraction t) const;
  };
  Curve row_at(Segments::Fraction u) const;
  Curve border_along(Side side) const;
  /// Returns the corner at which a side starts in the ring.
  Vec3 start_of(Side side) const;

  const BezierPatch& patch_;
  Vec3 origin_;
  HomogeneousNet net_;
};

}}  // namespace tessera::abi_0_1
