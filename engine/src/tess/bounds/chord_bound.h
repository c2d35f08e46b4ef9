#pragma once
// How far the triangles of a patch can lie from it, proven from its control net.
//
// A triangle with its corners on a polynomial piece, and with a parameter box h x k inside a rectangle over which
// |r_uu| <= uu, |r_uv| <= uv, |r_vv| <= vv, lies within (h^2 uu + 2 h k uv + k^2 vv) / 8 of it (Filip, Magedson, Markot 1986,
// Surface algorithms using bounds on derivatives; for any such triangle: Taylor at the point, the weighted variance of a
// coordinate over the corners being at most a quarter of its squared range, Cauchy-Schwarz for the mixed term).
//
// A direction w has an error of at most (h^2 max(w.uu) + 2 h k max|w.uv| + k^2 max(w.vv)) / 8 there, the maxima at least 0,
// each at a place of its own: so the distance is at most that of the longest sum h^2 uu + 2 h k uv + k^2 vv of such
// vectors, or without uu, or vv, which products of them bound.
//
// Rational patches: interpolate A = (w (r - c), w) over the triangle's parameters. What comes out, projected, runs
// through the flat triangle, since the weights are positive; and with the errors e of A's parts
//   |A / w - A' / w'| = |e_A - (r' - c) e_w| / w <= (|e_A| + R |e_w|) / w_min
// where r' lies within R of c. So the second derivatives of A and of w take the place of those of r. A bound between sets:
// it does not ask that equal parameters lie near each other. It grows with the patch's length (R w'' counts in full), but
// points may slip along the surface: where weights are uneven it is the smaller one. Beside it stands the bound by the
// second derivatives of r = P / w themselves, by exact numerators (kernel/chord/exact_chord.inl.h), which knows neither place nor
// length. A patch takes the one with fewer cells.
//
// Scaled sweeps: r(u,v) = rho(v) E(u) + T(v) with rho >= 0, as are all surfaces of revolution, cylinders, cones, extrusions
// and bilinear trapezoids, polynomial or rational (then with weights a_i b_j; it shows in the control points). There
//   the mixed derivative does not count: a triangle lies within (h^2 uu + k^2 vv) / 8.
// Proof. Let a point of a triangle with corners (u_c, v_c) have the shares t_c, let v' = sum t_c v_c, and
// u' = sum t_c rho_c u_c / sum t_c rho_c with rho_c = rho(v_c), which lies among the u_c. With R = sum t_c rho_c
//   sum t_c r(u_c, v_c) - r(u', v') = [sum t_c rho_c E(u_c) - R E(u')] + [sum t_c r(u', v_c) - r(u', v')].
// The first bracket is the error of interpolating R E from corners of the shares t_c rho_c / R, whose mean is u': at most
// h^2 R |E''| / 8, and R lies among the rho_c, so R E'' is an r_uu. The second is the error along v at one u: at most
// k^2 vv / 8. The map from (sum t_c u_c, v') to (u', v') depends on an edge's ends alone along an edge, is the identity on
// edges along u or v, and so on the patch's border: it is continuous and covers the patch. So every point of either set has
// one of the other that near, wherever the triangles of grid and strips have their corners. A patch within d of a sweep lies
// within 2 d more of its triangles.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "tess/plan/segments.h"
#include "tessera/bezier_patch.h"

namespace tessera::inline abi_0_1 {

/// Bounds that hold over a rectangle of the patch, in the patch's lengths over its own parameters.
struct SecondDerivatives {
  double uu = 0, uv = 0, vv = 0;
  /// Bounds on products of one derivative at a place and another at another: uu . vv, |uu . uv|, |uv . vv|; infinite where
  /// they are not known.
  double uu_vv = std::numeric_limits<double>::infinity(), uu_uv = uu_vv, uv_vv = uu_vv;

  /// The largest distance of a triangle with a parameter box h x k.
  double chord(double h, double k) const {
    const double a = h * h * uu, b = 2 * h * k * uv, c = k * k * vv;
    if (std::isinf(uu_vv)) return (a + b + c) / 8;
    const double both = a * a + c * c + 2 * (h * k) * (h * k) * uu_vv;
    const double squared = b * b + 4 * h * k * (h * h * uu_uv + k * k * uv_vv) + std::max({both, a * a, c * c});
    const bool is_sound = squared > std::numeric_limits<double>::min() / std::numeric_limits<double>::epsilon();
    return (is_sound ? std::min(a + b + c, (1 + 0x1p-48) * std::sqrt(squared)) : a + b + c) / 8;
  }
  /// By rates; a float parameter i / rate lies up to 2^-25 beside it.
  double chord(Rates rates) const { return chord(1.0 / rates.u + 0x1p-24, 1.0 / rates.v + 0x1p-24); }
};

inline constexpr int max_product_degree = 5;

/// Bounds for the whole patch, its halves and its quarters. Those of a half hold only for triangles that lie in one half:
/// so they serve even rates, whose cells never straddle the middle, but for one triangle at a border of an odd rate.
class ChordBound {
 public:
  /// Exact but for rounding, which is added: a proven bound. Infinite where it is beyond double.
  /// `products`: with those of second derivatives, up to max_product_degree: time goes by the degree's fourth power.
  explicit ChordBound(const BezierPatch& patch, bool products = false);
  ChordBound() = default;                           ///< of a plane
  using Pieces = std::array<SecondDerivatives, 9>;  ///< whole; u < 1/2, u > 1/2; v < 1/2, v > 1/2; quarters
  explicit ChordBound(const Pieces& pieces) : pieces_(pieces) {}
  const Pieces& pieces() const { return pieces_; }
  /// uu, uv and vv alone, for where many bounds are kept.
  using PlainPieces = std::array<std::array<double, 3>, 9>;
  explicit ChordBound(const PlainPieces& pieces) {
    for (std::size_t k = 0; k < pieces.size(); ++k) pieces_[k] = {pieces[k][0], pieces[k][1], pieces[k][2]};
  }
  PlainPieces plain_pieces() const {
    PlainPieces plain;
    for (std::size_t k = 0; k < plain.size(); ++k) plain[k] = {pieces_[k].uu, pieces_[k].uv, pieces_[k].vv};
    return plain;
  }

  /// The largest distance between the patch and a mesh of it, each of whose triangles has a parameter box of at most
  /// 1 / rates.u x 1 / rates.v, and where a rate is even none straddles the middle of that parameter.
  double distance(Rates rates) const;
  /// Of segments of any length in the halves, the same.
  double distance_of(PatchSegments segments) const;
  /// At a border of an odd rate beside an even one a triangle straddles the middle of the parameter, its box no wider than
  /// the border's segments: it lies in this one of pieces(), and keeps what that one says of these rates.
  struct Straddling {
    std::size_t piece;
    Rates rates;
  };
  static Straddling straddling(Rates rates, Edge border, int rate);
  /// The smallest real rate along the other parameter that keeps it, `fixed` being that along u or v; among even rates, or
  /// odd ones. Infinite if there is none.
  double needed(double tolerance, int fixed, bool fixed_u, bool even) const;
  /// The rates with the fewest cells that keep distance() <= tolerance; none up to `most` do: empty. tolerance > 0.
  std::optional<Rates> cheapest(double tolerance, int most) const;

 private:
  /// The pieces to look at: [split in u][split in v], the number of them, and their place in pieces_.
  struct Split {
    int first, count;
  };
  static constexpr Split splits[2][2] = {{{0, 1}, {3, 2}}, {{1, 2}, {5, 4}}};
  /// The smallest rate along the other parameter, with `fixed` along u or v.
  std::optional<Rates> with_rate(double tolerance, int fixed, bool fixed_u, int most) const;

  Pieces pieces_;
};

}  // namespace tessera::inline abi_0_1
