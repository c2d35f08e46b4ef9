#pragma once
// Cubic Hermite polynomials and their derivatives at one parameter, in the order position 0, tangent 0, tangent 1,
// position 1: H0 = 1-3t^2+2t^3, H1 = t-2t^2+t^3, H2 = -t^2+t^3, H3 = 3t^2-2t^3 (Farin, Curves and Surfaces for CAGD,
// 5th ed., sec. 7.5).

#include <array>

namespace tessera { inline namespace abi_0_1 {

// All functions take any finite t. They use products, which do not cancel on [0,1].

/// Returns H_i(t), exactly 0 and 1 at t = 0 and t = 1.
inline std::array<double, 4> hermite_values(double t) {
  const double s = 1 - t;
  return {s * s * (1 + 2 * t), t * (s * s), -(t * t) * s, t * t * (3 - 2 * t)};
}
/// Returns H_i'(t).
inline std::array<double, 4> hermite_derivatives(double t) {
  const double s = 1 - t;
  return {-6 * (t * s), s * (1 - 3 * t), t * (3 * t - 2), 6 * (t * s)};
}
/// Returns H_i''(t).
inline std::array<double, 4> hermite_second_derivatives(double t) {
  return {12 * t - 6, 6 * t - 4, 6 * t - 2, 6 - 12 * t};
}

}}  // namespace tessera::abi_0_1
