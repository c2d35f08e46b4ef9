#pragma once
// The exact sign of the area of a triangle in the parameter plane.

#include <cmath>

#include "tessera/geometry.h"

namespace tessera::inline abi_0_1 {

/// Returns what orientation() returns, from sums without rounding.
[[gnu::cold]] double orientation_exactly(const ParameterPoint& a, const ParameterPoint& b, const ParameterPoint& c);

/// Returns a number with the exact sign of the area of the triangle a, b, c: positive if it runs counter-clockwise,
/// zero if the three points lie on one line. Parameters and their products must neither overflow nor underflow.
///
/// The determinant in double decides where it exceeds its rounding, which is at most (3 + 16 e) e (|left| + |right|)
/// with e = 2^-53 (Shewchuk, Adaptive precision floating-point arithmetic and fast robust geometric predicates, 1997).
inline double orientation(const ParameterPoint& a, const ParameterPoint& b, const ParameterPoint& c) {
  constexpr double rounding = (3 + 16 * 0x1p-53) * 0x1p-53;
  const double left = (a.u - c.u) * (b.v - c.v), right = (a.v - c.v) * (b.u - c.u);
  const double determinant = left - right;
  if (std::abs(determinant) >= rounding * (std::abs(left) + std::abs(right))) [[likely]]
    return determinant;
  return orientation_exactly(a, b, c);
}

}  // namespace tessera::inline abi_0_1
