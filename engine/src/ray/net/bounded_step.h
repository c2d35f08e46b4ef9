#pragma once
// Steps of Newton's method within the unit square, to the closest point of a net to a ray, borders included.

#include <algorithm>
#include <cmath>
#include <limits>

#include "ray/net/projected_net.h"

namespace tessera { inline namespace abi_0_1 {

struct NetParameters {
  double u = 0, v = 0;
};

namespace bounded {

/// Finds the best point of one side of the square for the linear model; true if it beats `best`.
inline bool try_side(const NetValue& f, NetParameters from, bool fixed_u, double at, NetParameters& to, double& best) {
  const double across = at - (fixed_u ? from.u : from.v);
  const double x = f.x + across * (fixed_u ? f.xu : f.xv), y = f.y + across * (fixed_u ? f.yu : f.yv);
  const double dx = fixed_u ? f.xv : f.xu, dy = fixed_u ? f.yv : f.yu;
  const double square = dx * dx + dy * dy, along = square > 0 ? -(dx * x + dy * y) / square : 0;
  const double start = fixed_u ? from.v : from.u, end = std::clamp(start + along, 0.0, 1.0);
  const double rx = x + (end - start) * dx, ry = y + (end - start) * dy, residual = rx * rx + ry * ry;
  if (!(residual < best)) return false;
  best = residual;
  to = fixed_u ? NetParameters{at, end} : NetParameters{end, at};
  return true;
}

}  // namespace bounded

/// Returns the point of [0,1]^2 where the linear model f + J d at `from` is smallest. A ray next to a border needs this
/// point and not Newton's point moved to the square. Where the derivatives are nearly parallel across the ray, the
/// moved point has an error of the rounding divided by the sine of their angle, the closest one only of the rounding.
inline NetParameters bounded_step(const NetValue& f, NetParameters from) {
  constexpr double parallel = 1e-9;  // sine of the angle
  const double determinant = f.xu * f.yv - f.xv * f.yu;
  const double uu = f.xu * f.xu + f.yu * f.yu, vv = f.xv * f.xv + f.yv * f.yv;
  double du = 0, dv = 0;
  if (std::abs(determinant) > parallel * std::sqrt(uu * vv)) {
    du = -(f.x * f.yv - f.y * f.xv) / determinant;
    dv = -(f.y * f.xu - f.x * f.yu) / determinant;
  } else {  // the shortest of all equally good ones, slightly damped (Levenberg, 1944)
    const double damping = 1e-14 * (uu + vv), a = uu + damping, c = vv + damping;
    const double b = f.xu * f.xv + f.yu * f.yv, gu = f.xu * f.x + f.yu * f.y, gv = f.xv * f.x + f.yv * f.y;
    const double det = a * c - b * b;
    if (det > 0) du = -(gu * c - gv * b) / det, dv = -(gv * a - gu * b) / det;
  }
  const NetParameters to{from.u + du, from.v + dv};
  if (to.u >= 0 && to.u <= 1 && to.v >= 0 && to.v <= 1) return to;
  NetParameters best = from;
  double residual = std::numeric_limits<double>::infinity();
  for (const double side : {0.0, 1.0}) {
    bounded::try_side(f, from, true, side, best, residual);
    bounded::try_side(f, from, false, side, best, residual);
  }
  return best;
}

}}  // namespace tessera::abi_0_1
