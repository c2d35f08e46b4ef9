#pragma once
// How far the triangles of a patch can lie from it, proven from its control net.
//
// A triangle with its corners on a polynomial piece, and with a parameter box h x k inside a rectangle over which
// |r_uu| <= uu, |r_uv| <= uv, |r_vv| <= vv, lies within (h^2 uu + 2 h k uv + k^2 vv) / 8 of it (Filip, Magedson, Markot 1986,
// Surface algorithms using bounds on derivatives; for any such triangle: Taylor at the point, the weighted variance of a
// coordinate over the corners being at most a quarter of its squared range, Cauchy-Schwarz for the mixed term).
//
// Rational patches: interpolate A = (w (r - c), w) over the triangle's parameters. What comes out, projected, runs
// through the flat triangle, since the weights are positive; and with the errors e of A's parts
//   |A / w - A' / w'| = |e_A - (r' - c) e_w| / w <= (|e_A| + R |e_w|) / w_min
// where r' lies within R of c. So the second derivatives of A and of w take the place of those of r. A bound between sets:
// it does not ask that equal parameters lie near each other.

#include <array>
#include <optional>

#include "tess/patch_triangles.h"
#include "tessera/bezier_patch.h"

namespace tessera {

/// Bounds that hold over a rectangle of the patch, in the patch's lengths over its own parameters.
struct SecondDerivatives {
  double uu = 0, uv = 0, vv = 0;

  /// The largest distance of a triangle with a parameter box h x k.
  double chord(double h, double k) const { return (h * h * uu + 2 * h * k * uv + k * k * vv) / 8; }
  /// By rates; a float parameter i / rate lies up to 2^-25 beside it.
  double chord(Rates rates) const { return chord(1.0 / rates.u + 0x1p-24, 1.0 / rates.v + 0x1p-24); }
};

/// Bounds for the whole patch, its halves and its quarters. Those of a half hold only for triangles that lie in one half:
/// so they serve even rates, whose cells never straddle the middle.
class ChordBound {
 public:
  /// Exact but for rounding, which is added: a proven bound. Infinite where it is beyond double.
  explicit ChordBound(const BezierPatch& patch);
  ChordBound() = default;  ///< of a plane
  using Pieces = std::array<SecondDerivatives, 9>;  ///< whole; u < 1/2, u > 1/2; v < 1/2, v > 1/2; quarters
  explicit ChordBound(const Pieces& pieces) : pieces_(pieces) {}
  const Pieces& pieces() const { return pieces_; }

  /// The largest distance between the patch and a mesh of it, each of whose triangles has a parameter box of at most
  /// 1 / rates.u x 1 / rates.v, and where a rate is even none straddles the middle of that parameter.
  double distance(Rates rates) const;
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
  static constexpr Split splits_[2][2] = {{{0, 1}, {3, 2}}, {{1, 2}, {5, 4}}};
  /// The smallest rate along the other parameter, with `fixed` along u or v.
  std::optional<Rates> with_rate(double tolerance, int fixed, bool fixed_u, int most) const;

  Pieces pieces_;
};

}  // namespace tessera
