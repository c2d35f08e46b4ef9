#include "trim/piece_side.h"

#include <cmath>

#include "basis/exact_sign.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

bool has_height(const TrimPiece& piece, double v) { return piece.lower_v() <= v && v < piece.upper_v(); }

/// The largest differences between a point of the piece's box and one of its control points.
ParameterPoint extent(const TrimPiece& piece) { return distance(piece.start(), piece.end()); }

PieceSide side_of_line(const TrimPiece& piece, const ParameterPoint& q) {
  if (q.v < piece.lower_v() || q.v > piece.upper_v()) return PieceSide::beside;
  const bool up = piece.line_from.v < piece.line_to.v;
  const ParameterPoint &lower = up ? piece.line_from : piece.line_to, &upper = up ? piece.line_to : piece.line_from;
  if (lower.v == upper.v) return q.u >= piece.lower_u() && q.u <= piece.upper_u() ? PieceSide::near : PieceSide::beside;
  const int side = orientation(lower, upper, q);
  if (side == 0) return PieceSide::near;
  if (!has_height(piece, q.v)) return PieceSide::beside;
  return side > 0 ? PieceSide::left : PieceSide::right;
}

/// The side of q that a point of the curve tells, in directions in which u and v increase along the curve.
enum class Quadrant {
  near,    ///< too near for its signs to be certain
  across,  ///< ahead in one coordinate and behind in the other: the side is decided
  before,  ///< not ahead in either: no earlier point decides
  beyond,  ///< not behind in either: no later point decides
};

class SideSearch {
 public:
  SideSearch(const TrimPiece& piece, const ParameterPoint& q) : piece_(piece), q_(q), size_(extent(piece)) {
    // Control points lie between the ends, which bound their differences from q.
    const ParameterPoint farthest = larger(distance(piece.start(), q), distance(piece.end(), q));
    near_ = piece.error + plane_error(piece.curve.degree()) * farthest;
    sign_u_ = piece.start().u > piece.end().u ? -1 : 1;
    sign_v_ = piece.start().v > piece.end().v ? -1 : 1;
  }

  PieceSide run() const {
    const ParameterPoint start{piece_.start().u - q_.u, piece_.start().v - q_.v};
    const ParameterPoint end{piece_.end().u - q_.u, piece_.end().v - q_.v};
    const Quadrant at_start = quadrant(start), at_end = quadrant(end);
    if (at_start == Quadrant::near || at_end == Quadrant::near) return PieceSide::near;
    if (at_start != Quadrant::before) return decided(start);
    if (at_end != Quadrant::beyond) return decided(end);
    double lower = 0, upper = 1, f_lower = along(start), f_upper = along(end);
    for (int k = 0; upper - lower > 0x1p-60 && k < 200; ++k) {
      double t = 0.5 * lower + 0.5 * upper;
      if (k % 3 != 2) {
        const double guess = lower + (upper - lower) * (f_lower / (f_lower - f_upper));
        if (guess > lower && guess < upper) t = guess;
      }
      const ParameterPoint p = relative_point(piece_.curve, q_, t);
      const Quadrant at = quadrant(p);
      if (at == Quadrant::near) return PieceSide::near;
      if (at == Quadrant::across) return decided(p);
      (at == Quadrant::beyond ? upper : lower) = t;
      (at == Quadrant::beyond ? f_upper : f_lower) = along(p);
    }
    return PieceSide::near;  // the curve passes q within one step of t
  }

 private:
  Quadrant quadrant(const ParameterPoint& p) const {
    const double x = sign_u_ * p.u, y = sign_v_ * p.v;
    if (std::abs(x) <= near_.u && std::abs(y) <= near_.v) return Quadrant::near;
    if ((x > near_.u && y < -near_.v) || (x < -near_.u && y > near_.v)) return Quadrant::across;
    return x > near_.u || y > near_.v ? Quadrant::beyond : Quadrant::before;
  }

  /// The side by a point of the curve that is in a deciding quadrant, or by an end if all of the curve is on one side.
  PieceSide decided(const ParameterPoint& p) const {
    if (!has_height(piece_, q_.v)) return PieceSide::beside;
    return p.u > 0 ? PieceSide::left : PieceSide::right;
  }

  /// Increases along the curve, and vanishes in a deciding quadrant, across the chord if the box is made a square.
  double along(const ParameterPoint& p) const { return size_.v * sign_u_ * p.u + size_.u * sign_v_ * p.v; }

  const TrimPiece& piece_;
  const ParameterPoint q_;
  ParameterPoint size_, near_;
  double sign_u_, sign_v_;
};

}  // namespace

ParameterPoint reach(const TrimPiece& piece) {
  if (piece.exact_line) return {};
  return piece.error + 2 * plane_error(piece.curve.degree()) * (extent(piece) + piece.error);
}

PieceSide side_of(const TrimPiece& piece, const ParameterPoint& q) {
  return piece.exact_line ? side_of_line(piece, q) : SideSearch(piece, q).run();
}

}}  // namespace tessera::abi_0_1
