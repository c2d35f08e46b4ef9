#pragma once
// De Boor's algorithm on the degree + 1 homogeneous points that act on one span, for curves and B-spline surfaces.

#include <algorithm>
#include <array>
#include <cstddef>

#include "surface/net/homogeneous.h"

namespace tessera { inline namespace abi_0_1 {

/// The degree + 1 points k-p .. k that act on the span k.
using SplineWindow = std::array<Homogeneous, max_degree + 1>;

/// The scale and origin of a window's homogeneous points. Points and weights are divided by powers of two that bring
/// the largest near 1, so that nothing overflows or underflows. Rational windows are relative to one of their points,
/// which reduces the effect of the weights' rounding and makes that point evaluate exactly.
struct WindowFrame {
  double scale = 1, weight_factor = 1;
  Vec3 scaled_origin;

  /// `largest_weight` is 0 for a polynomial; all weights are then 1.
  WindowFrame(double largest, double largest_weight, const Vec3& origin)
      : scale(power_of_two_near(largest)),
        weight_factor(1 / power_of_two_near(largest_weight)),
        scaled_origin((1 / scale) * origin) {}

  Homogeneous homogeneous(const Vec3& point, double weight) const {
    const double w = weight_factor * weight;
    const Vec3 p = w * ((1 / scale) * point - scaled_origin);
    return {p.x, p.y, p.z, w};
  }
  Vec3 position(const Vec3& p) const { return scale * (p + scaled_origin); }
  Vec3 vector(const Vec3& p) const { return scale * p; }
};
/// Returns the end of the window, 0 or degree, that lies on t's side of the span.
inline std::size_t nearer_end(int degree, const double* span, double t) {
  return t - span[0] > span[1] - t ? static_cast<std::size_t>(degree) : 0;
}

/// Value, first and second derivative.
using SplineJet = std::array<Homogeneous, 3>;

/// Returns the curve at t; `span` points at the knot u_k. Each step is an affine combination, convex for t within the
/// span (de Boor, A Practical Guide to Splines, ch. X; The NURBS Book, sec. 5.2).
inline Homogeneous de_boor(int degree, const double* span, double t, SplineWindow points) {
  for (int r = 1; r <= degree; ++r)
    for (int j = degree; j >= r; --j) {
      const double left = span[j - degree], right = span[j - r + 1], a = (t - left) / (right - left);
      Homogeneous& p = points[static_cast<std::size_t>(j)];
      p = (1 - a) * points[static_cast<std::size_t>(j - 1)] + a * p;
    }
  return points[static_cast<std::size_t>(degree)];
}

/// Returns the points of the derivative, one fewer: p (P_{i+1} - P_i) / (u_{i+p+1} - u_{i+1}) (The NURBS Book, eq.
/// 3.4). The derivative has degree - 1, the same knots and the same span.
inline SplineWindow derivative_points(int degree, const double* span, const SplineWindow& points) {
  SplineWindow result{};
  for (int j = 0; j < degree; ++j) {
    const std::size_t k = static_cast<std::size_t>(j);
    result[k] = (degree / (span[j + 1] - span[j + 1 - degree])) * (points[k + 1] - points[k]);
  }
  return result;
}

inline SplineJet spline_jet(int degree, const double* span, double t, const SplineWindow& points) {
  const SplineWindow first = derivative_points(degree, span, points);
  const SplineWindow second = degree < 2 ? SplineWindow{} : derivative_points(degree - 1, span, first);
  return {de_boor(degree, span, t, points), de_boor(degree - 1, span, t, first),
          de_boor(std::max(degree - 2, 0), span, t, second)};
}

}}  // namespace tessera::abi_0_1
