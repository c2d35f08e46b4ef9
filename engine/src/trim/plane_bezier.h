#pragma once
// Bezier curves in the parameter plane: points in double and in double-double, parts, roots of derivatives.

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "basis/double_double.h"
#include "tessera/bezier_patch.h"
#include "tessera/geometry.h"
#include "trim/short_list.h"

namespace tessera { inline namespace abi_0_1 {

/// A Bezier curve of degree 1 to max_degree over [0, 1]; rational if it has weights, which are positive.
struct PlaneBezier {
  static constexpr std::size_t points_in_place = 4;  // most curves are of degree 1 to 3
  ShortList<ParameterPoint, points_in_place> points;
  ShortList<double, points_in_place> weights = {};  ///< one per point; empty for a polynomial curve

  int degree() const { return static_cast<int>(points.size()) - 1; }
  double weight(std::size_t i) const { return weights.empty() ? 1 : weights[i]; }
};

inline ParameterPoint operator+(const ParameterPoint& a, const ParameterPoint& b) { return {a.u + b.u, a.v + b.v}; }
inline ParameterPoint operator*(double s, const ParameterPoint& a) { return {s * a.u, s * a.v}; }
/// Returns |a - b| in u, and in v.
inline ParameterPoint distance(const ParameterPoint& a, const ParameterPoint& b) {
  return {std::abs(a.u - b.u), std::abs(a.v - b.v)};
}
/// Returns the larger u, and the larger v.
inline ParameterPoint larger(const ParameterPoint& a, const ParameterPoint& b) {
  return {std::max(a.u, b.u), std::max(a.v, b.v)};
}

/// A point to about 100 bits.
struct PrecisePoint {
  DoubleDouble u, v;
  ParameterPoint rounded() const { return {u.rounded(), v.rounded()}; }
};

/// Returns C(t), 0 <= t <= 1, by de Casteljau's algorithm in double-double, homogeneous for rational curves.
PrecisePoint precise_point(const PlaneBezier& curve, double t);

/// Returns the part over [t0, t1], 0 <= t0 < t1 <= 1, as a curve over [0, 1]. Every control point is rounded once.
PlaneBezier part(const PlaneBezier& curve, double t0, double t1);

/// Appends the parameters in (0, 1) where the derivative of u (`along` = 0) or v (1) changes its sign, up to rounding,
/// in increasing order. Every interval between them is monotone up to rounding.
void append_extrema(const PlaneBezier& curve, int along, std::vector<double>& parameters);

/// Returns C(t) - q in double, 0 <= t <= 1. Each coordinate has an error of at most plane_error(degree) times the
/// largest absolute difference of a control point's coordinate from q's: every control point's share passes through at
/// most 3 roundings a level, and a difference, a weight, two sums' quotient besides.
inline ParameterPoint relative_point(const PlaneBezier& curve, const ParameterPoint& q, double t) {
  const std::size_t count = curve.points.size();
  std::array<double, max_degree + 1> u, v, w;
  const bool rational = !curve.weights.empty();
  for (std::size_t i = 0; i < count; ++i) {
    const double weight = rational ? curve.weights[i] : 1;
    u[i] = weight * (curve.points[i].u - q.u);
    v[i] = weight * (curve.points[i].v - q.v);
    w[i] = weight;
  }
  const double s = 1 - t;
  for (std::size_t last = count - 1; last > 0; --last) {
    for (std::size_t i = 0; i < last; ++i) {
      u[i] = s * u[i] + t * u[i + 1];
      v[i] = s * v[i] + t * v[i + 1];
    }
    if (!rational) continue;
    for (std::size_t i = 0; i < last; ++i) w[i] = s * w[i] + t * w[i + 1];
  }
  return rational ? ParameterPoint{u[0] / w[0], v[0] / w[0]} : ParameterPoint{u[0], v[0]};
}
/// See relative_point().
inline double plane_error(int degree) { return (6 * degree + 8) * 0x1p-53; }

}}  // namespace tessera::abi_0_1
