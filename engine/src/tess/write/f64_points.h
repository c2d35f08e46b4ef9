#pragma once
// Vertices in double, for tolerances that float sums do not keep: from the set's double control points, rounded once.

#include "surface/homogeneous.h"
#include "tess/write/stitched_patch.h"

namespace tessera::inline abi_0_1 {

/// The largest distance between a vertex that F64Points gives, rounded to float, and the surface's point at the exact
/// parameters. Lengths are those of the model, relative to the set's origin.
///
/// With V_ij the control points relative to the origin, S = sum B_i B_j w_ij V_ij / sum B_i B_j w_ij and u = 2^-53, each
/// term goes through these roundings: of V_ij, and of its product with w_ij; of B_i, m of the fractions i / n and
/// (n - i) / n, at most m + 1 of their powers, and one of the binomial; of B_j as many by n; of the products of B_i and B_j
/// with the rest; m + n of the sums. They are at most 3 (m + n) + 8 (Higham, Accuracy and Stability of Numerical
/// Algorithms, 2nd ed., sec. 3.1), so the sum is off by a vector of at most
///   g sum B_i B_j w_ij |V_ij|,  g = (3 (m + n) + 8) u,
/// component by component, and so is the sum of weights, relative to itself. Since the B_i B_j w_ij over their sum are
/// shares, the point is off by at most 2 g R and the division's rounding, where R = max |V_ij|. Rounded to nearest, a float
/// is off by at most 2^-24 of each component, so the vertex by at most 2^-24 |S| <= 2^-24 R, or 2^-150 where float
/// underflows.
double f64_vertex_rounding(const BezierPatch& patch, const Vec3& origin);
/// The rounding of a vertex in double to which the origin is added: off by at most u |P| <= u max |P_ij| where it was rounded to
/// float, with P_ij the control points.
double f64_position_rounding(const BezierPatch& patch, const Vec3& origin);

/// The vertices of one patch, relative to the set's origin. Allocates nothing; the same bits on all instruction sets.
/// Points of a border depend on its own control points alone, and not on the direction in which it runs; corners, and all of
/// a collapsed border, are control points.
class F64Points {
 public:
  /// The patch must outlive them.
  F64Points(const BezierPatch& patch, const Vec3& origin) : patch_(patch), origin_(origin), net_(patch, origin) {}

  /// visit(point) for the inner points of a division, in its order.
  template <class Visit>
  void for_inner(const Division& division, Visit visit) const {
    for (int iu = 1; iu < division.inner.u.rate(); ++iu) {
      const Curve row = row_at(division.inner.u.at(iu));
      for (int iv = 1; iv < division.inner.v.rate(); ++iv) visit(row.at(division.inner.v.at(iv)));
    }
  }
  /// visit(k, point) for point k = 0 .. rate - 1 of a side, as the ring runs.
  template <class Visit>
  void for_border(const Division& division, Side side, Visit visit) const {
    const Segments along = division.border[static_cast<std::size_t>(side)];
    const int rate = along.rate();
    const Vec3 start = start_of(side);
    visit(0, start);
    if (division.collapsed.has(edge_of(side))) {
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
    double scale;  ///< of the net's numbers to the model's lengths
    std::array<Homogeneous, max_degree + 1> points;

    Vec3 at(Segments::Fraction t) const;
  };
  Curve row_at(Segments::Fraction u) const;
  Curve border_along(Side side) const;
  /// The corner at which a side starts in the ring.
  Vec3 start_of(Side side) const;

  const BezierPatch& patch_;
  Vec3 origin_;
  HomogeneousNet net_;
};

}  // namespace tessera::inline abi_0_1
