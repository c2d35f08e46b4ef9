#pragma once
// Bounds how far the triangles of a patch can lie from it, proven from its control net.
//
// Polynomial patches. A triangle with its corners on a piece, and with a parameter box h x k inside a rectangle over
// which |r_uu| <= uu, |r_uv| <= uv, |r_vv| <= vv, lies within
//   (h^2 uu + 2 h k uv + k^2 vv) / 8
// of the piece (Filip, Magedson, Markot 1986, Surface algorithms using bounds on derivatives). This holds for any such
// triangle, by Taylor at the point: the weighted variance of a coordinate over the corners is at most a quarter of its
// squared range, and Cauchy-Schwarz bounds the mixed term.
//
// Products. In a direction w the error is at most (h^2 max(w.uu) + 2 h k max|w.uv| + k^2 max(w.vv)) / 8, where each
// maximum is at least 0 and has a place of its own. So the distance is at most an eighth of the longest sum
//   h^2 uu + 2 h k uv + k^2 vv
// of such vectors, or of such a sum without uu, or vv. Products of the vectors bound its length.
//
// Rational patches. Interpolate A = (w (r - c), w) over the triangle's parameters. The projection of the interpolant
// runs through the flat triangle, since the weights are positive. With the errors e of A's parts
//   |A / w - A' / w'| = |e_A - (r' - c) e_w| / w <= (|e_A| + R |e_w|) / w_min
// where r' lies within R of c. So the second derivatives of A and of w take the place of those of r. This bounds the
// distance between the two sets and does not need equal parameters to lie near each other.
//
// - It grows with the patch's length (R w'' counts in full), but lets points slip along the surface: where weights are
//   uneven it is the smaller bound.
// - The other bound takes the second derivatives of r = P / w themselves, by exact numerators
//   (kernel/chord/exact_chord.inl.h), and depends on neither place nor length.
// - A patch takes the bound with fewer cells.
//
// Scaled sweeps: r(u,v) = rho(v) E(u) + T(v) with rho >= 0. All surfaces of revolution, cylinders, cones, extrusions
// and bilinear trapezoids are such sweeps, polynomial or rational (then with weights a_i b_j); their control points
// show it. Here the mixed derivative does not count: a triangle lies within (h^2 uu + k^2 vv) / 8.
//
// Proof:
// 1. Take a point of a triangle with corners (u_c, v_c), and its shares t_c of the corners. Let
//      rho_c = rho(v_c), R = sum t_c rho_c, v' = sum t_c v_c, u' = sum t_c rho_c u_c / R.
//    Then u' lies among the u_c.
// 2. The point's difference from r(u', v') splits into two brackets:
//      sum t_c r(u_c, v_c) - r(u', v') = [sum t_c rho_c E(u_c) - R E(u')] + [sum t_c r(u', v_c) - r(u', v')].
// 3. The first bracket is the error of interpolating R E from corners with the shares t_c rho_c / R, whose mean is u'.
//    It is at most h^2 R |E''| / 8. R lies among the rho_c, so R E'' is a value of r_uu: at most h^2 uu / 8.
// 4. The second bracket is the error along v at one u: at most k^2 vv / 8.
// 5. The map from (sum t_c u_c, v') to (u', v') depends, along an edge, only on the edge's ends. It is the identity on
//    edges along u or v, and so on the patch's border. So it is continuous and covers the patch: every point of either
//    set has one of the other within the bound, wherever the triangles of grid and strips have their corners.
//
// A patch within d of a sweep lies within 2 d more of its triangles.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "tess/cells/segments.h"
#include "tessera/bezier_patch.h"

namespace tessera { inline namespace abi_0_1 {

/// Bounds on second derivatives over a rectangle of the patch, in the patch's lengths over its own parameters.
struct SecondDerivatives {
  double uu = 0, uv = 0, vv = 0;
  /// Bounds on the products uu . vv, |uu . uv|, |uv . vv| of two derivatives, each at any place; infinite if unknown.
  double uu_vv = std::numeric_limits<double>::infinity(), uu_uv = uu_vv, uv_vv = uu_vv;

  /// Returns the largest distance of a triangle with a parameter box h x k.
  double chord(double h, double k) const {
    const double a = h * h * uu, b = 2 * h * k * uv, c = k * k * vv;
    if (std::isinf(uu_vv)) return (a + b + c) / 8;
    const double both = a * a + c * c + 2 * (h * k) * (h * k) * uu_vv;
    const double squared = b * b + 4 * h * k * (h * h * uu_uv + k * k * uv_vv) + std::max({both, a * a, c * c});
    const bool is_sound = squared > std::numeric_limits<double>::min() / std::numeric_limits<double>::epsilon();
    return (is_sound ? std::min(a + b + c, (1 + 0x1p-48) * std::sqrt(squared)) : a + b + c) / 8;
  }
  /// Returns the largest distance at these rates. A float parameter lies up to 2^-25 beside i / rate.
  double chord(Rates rates) const { return chord(1.0 / rates.u + 0x1p-24, 1.0 / rates.v + 0x1p-24); }
};

inline constexpr int max_product_degree = 5;

/// Bounds for the whole patch, its halves and its quarters. Bounds of a half hold only for triangles that lie in that
/// half. So they suit even rates, whose cells never cross the middle, except for one triangle at a border of an odd
/// rate.
class ChordBound {
 public:
  /// Bounds a patch: a proven bound, exact up to rounding, which is added. Infinite where it is beyond double.
  /// `products`: also bounds those of second derivatives, for degrees up to max_product_degree. Time: by the degree's
  /// fourth power.
  explicit ChordBound(const BezierPatch& patch, bool products = false);
  ChordBound() = default;                           ///< bounds a plane
  using Pieces = std::array<SecondDerivatives, 9>;  ///< whole; u < 1/2, u > 1/2; v < 1/2, v > 1/2; quarters
  explicit ChordBound(const Pieces& pieces) : pieces_(pieces) {}
  const Pieces& pieces() const { return pieces_; }
  /// Only uu, uv and vv of each piece, for holders of many bounds.
  using PlainPieces = std::array<std::array<double, 3>, 9>;
  explicit ChordBound(const PlainPieces& pieces) {
    for (std::size_t k = 0; k < pieces.size(); ++k) pieces_[k] = {pieces[k][0], pieces[k][1], pieces[k][2]};
  }
  PlainPieces plain_pieces() const {
    PlainPieces plain;
    for (std::size_t k = 0; k < plain.size(); ++k) plain[k] = {pieces_[k].uu, pieces_[k].uv, pieces_[k].vv};
    return plain;
  }

  /// Returns the largest distance between the patch and a mesh of it. Each triangle of the mesh must have a parameter
  /// box of at most 1 / rates.u x 1 / rates.v; where a rate is even, none may cross the middle of that parameter.
  double distance(Rates rates) const;
  /// Returns the largest distance for segments that may differ in length. `anywhere`: triangles may cross the middle of
  /// a parameter even if these segments do not; each lies in one of these segments, or in a finer one of a border.
  double distance_of(PatchSegments segments, bool anywhere = false) const;
  /// The bound of a triangle that crosses the middle of a parameter, at a border of an odd rate beside an even one. Its
  /// box is no wider than the border's segments, so it lies in this one of pieces() and keeps the piece's chord at
  /// these rates.
  struct Crossing {
    std::size_t piece;
    Rates rates;
  };
  static Crossing crossing(Rates rates, Side border, int rate);
  /// Returns the smallest real rate along the other parameter that keeps the tolerance, with the rate `fixed` along u
  /// or v; infinite if there is none. `even`: by the bounds of even rates, else of odd ones. Products are not used.
  double needed(double tolerance, int fixed, bool fixed_u, bool even) const;
  /// Returns the same for triangles of a quarter, 2 (u > 1/2) + (v > 1/2), with a real rate there.
  double needed_in_quarter(double tolerance, double fixed, bool fixed_u, int quarter) const;
  /// Returns the rates with the fewest cells that keep distance() <= tolerance > 0; empty if none up to `most` do.
  std::optional<Rates> cheapest(double tolerance, int most) const;

  /// The pieces that rates use: their place in pieces() and their number.
  struct Split {
    int first, count;
  };
  static Split split(Rates rates) { return splits[rates.u % 2 == 0][rates.v % 2 == 0]; }

 private:
  /// Splits by [split in u][split in v].
  static constexpr Split splits[2][2] = {{{0, 1}, {3, 2}}, {{1, 2}, {5, 4}}};
  /// Returns the rates with `fixed` along u or v and the smallest rate along the other parameter.
  std::optional<Rates> with_rate(double tolerance, int fixed, bool fixed_u, int most) const;

  Pieces pieces_;
};

}}  // namespace tessera::abi_0_1
