#pragma once
// Proofs about the roots of a net's (x, y) in its square, from the hulls of its derivatives.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "ray/net/bounded_step.h"
#include "ray/net/projected_net.h"

namespace tessera { inline namespace abi_0_1 {

/// The lowest and highest of some coefficients.
struct Hull {
  double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();
  void extend(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  double centre() const { return 0.5 * (low + high); }
  double radius() const { return 0.5 * (high - low); }
  double largest() const { return std::max(-low, high); }
};

/// Hulls of the derivatives of one component over the square: of its differences, times the degree (Farin, eq. 5.23).
struct DerivativeHulls {
  Hull u, v;
};

template <class Shape>
DerivativeHulls derivative_hulls(const Shape& shape, const double* component) {
  const int columns = shape.columns(), size = shape.size();
  DerivativeHulls out;
  for (int k = 0; k < size - columns; ++k) out.u.extend(component[k + columns] - component[k]);
  for (int i = 0; i < size; i += columns) {
    for (int k = i; k < i + shape.n(); ++k) out.v.extend(component[k + 1] - component[k]);
  }
  out.u.low *= shape.m(), out.u.high *= shape.m();
  out.v.low *= shape.n(), out.v.high *= shape.n();
  return out;
}

/// The map x -> x - A f(x) with a constant A near the inverse of the Jacobian J, in the maximum norm.
/// 1. For points x, y of the square |(x - A f(x)) - (y - A f(y))|_i <= row[i] max|x - y| with row[i] = sum_j max |I - A
///    J|_ij (the mean value theorem with Krawczyk's operator: Neumaier, Interval Methods for Systems of Equations, sec.
///    5.1).
/// 2. If both rows are below 1 the square holds at most one root.
///
/// This holds for the true net. The computed net has an error of at most `rounding` times the weight in each
/// coefficient; so derivatives have one of 2 degree rounding, A f one of `spread`, and A itself is any matrix. Rounding
/// in this computation is bounded by eps times the sums of magnitudes.
struct RootCertificate {
  double a[2][2] = {};
  double row[2] = {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  double spread[2] = {};
  bool regular = false;  ///< false: the mean Jacobian is singular

  double contraction() const { return std::max(row[0], row[1]); }
  std::array<double, 2> step(const NetValue& f) const {
    return {a[0][0] * f.x + a[0][1] * f.y, a[1][0] * f.x + a[1][1] * f.y};
  }
};

/// `heaviest`: bounds the weights.
inline RootCertificate certify(const DerivativeHulls& x, const DerivativeHulls& y, int m, int n, double rounding,
                               double heaviest) {
  // The sums below have fewer than 8 roundings, of 2^-53 each.
  constexpr double epsilon = 4 * std::numeric_limits<double>::epsilon();
  // The determinant errs by 2^-52 of its products. Above this share of them, that adds less than 1e-3 to `row`. A
  // smaller determinant is treated as zero to save time: A may be any matrix, so the proof does not depend on it.
  constexpr double min_determinant = 1e-12;
  RootCertificate out;
  const double j[2][2] = {{x.u.centre(), x.v.centre()}, {y.u.centre(), y.v.centre()}};
  const double determinant = j[0][0] * j[1][1] - j[0][1] * j[1][0];
  const double products = std::abs(j[0][0] * j[1][1]) + std::abs(j[0][1] * j[1][0]);
  if (!(std::abs(determinant) > min_determinant * products)) return out;
  out.regular = true;
  out.a[0][0] = j[1][1] / determinant, out.a[0][1] = -j[0][1] / determinant;
  out.a[1][0] = -j[1][0] / determinant, out.a[1][1] = j[0][0] / determinant;
  const double off_u = 2 * m * rounding * heaviest, off_v = 2 * n * rounding * heaviest;
  const double radius[2][2] = {{x.u.radius() + off_u, x.v.radius() + off_v},
                               {y.u.radius() + off_u, y.v.radius() + off_v}};
  for (int i = 0; i < 2; ++i) {
    const double a0 = std::abs(out.a[i][0]), a1 = std::abs(out.a[i][1]);
    const double moved = a0 * (radius[0][0] + radius[0][1]) + a1 * (radius[1][0] + radius[1][1]);
    const double size = a0 * (std::abs(j[0][0]) + std::abs(j[0][1])) + a1 * (std::abs(j[1][0]) + std::abs(j[1][1]));
    out.row[i] = moved * (1 + epsilon) + epsilon * (1 + size + products / std::abs(determinant));
    out.spread[i] = (a0 + a1) * rounding * heaviest * (1 + epsilon);
  }
  return out;
}

/// The rectangle in which the roots of the square must lie.
struct RootBox {
  double low[2] = {0, 0}, high[2] = {1, 1};
  bool empty() const { return low[0] > high[0] || low[1] > high[1]; }
  double width(int i) const { return high[i] - low[i]; }
};

/// Bounds the roots from the value at one point: every root is within `distance` of the point, and the image of the
/// point within row * distance of the root.
inline RootBox roots_near(const RootCertificate& certificate, const NetValue& f, NetParameters at, double distance) {
  constexpr double epsilon = 8 * std::numeric_limits<double>::epsilon();
  const std::array<double, 2> step = certificate.step(f);
  RootBox box;
  for (int i = 0; i < 2; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const double image = (i == 0 ? at.u : at.v) - step[k];
    const double reach =
        (certificate.row[i] * distance + certificate.spread[i]) * (1 + epsilon) + epsilon * (1 + std::abs(step[k]));
    box.low[i] = std::max(0.0, image - reach);
    box.high[i] = std::min(1.0, image + reach);
  }
  return box;
}

/// Bounds the distance of the one root from `at`, for contraction() < 1: |at - x| <= |A f(at)| + k |at - x|.
inline double root_distance(const RootCertificate& certificate, const NetValue& f) {
  const std::array<double, 2> step = certificate.step(f);
  const double length = std::max(std::abs(step[0]) + certificate.spread[0], std::abs(step[1]) + certificate.spread[1]);
  return length / (1 - certificate.contraction()) * (1 + 1e-15);  // three roundings, of 2^-53 each
}

}}  // namespace tessera::abi_0_1
