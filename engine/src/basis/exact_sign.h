#pragma once
// Exact signs of sums and of the orientation of three points: a filter in plain double decides almost always, and
// expansions of doubles the rest (Shewchuk, Adaptive precision floating-point arithmetic and fast robust geometric
// predicates, 1997).

#include <cmath>
#include <span>

#include "tessera/geometry.h"

namespace tessera { inline namespace abi_0_1 {

/// Returns the sign, -1, 0 or 1, of the exact sum of at most 32 finite numbers.
int sign_of_sum(std::span<const double> terms);

/// Returns the exact sign of (a - c) x (b - c) by expansions, without a filter.
[[gnu::cold]] int exact_orientation(const ParameterPoint& a, const ParameterPoint& b, const ParameterPoint& c);

/// Returns 1 if c lies on the left of the line from a to b, -1 if it lies on its right, 0 if it lies on the line or a
/// == b. Exact for coordinates whose differences are 0 or between 2^-480 and 2^500 in absolute value.
inline int orientation(const ParameterPoint& a, const ParameterPoint& b, const ParameterPoint& c) {
  const double left = (a.u - c.u) * (b.v - c.v), right = (a.v - c.v) * (b.u - c.u);
  const double determinant = left - right;
  // Shewchuk's bound A: each of the four differences, two products and the last difference is rounded once.
  constexpr double unit = 0x1p-53, bound = (3 + 16 * unit) * unit;
  const double error = bound * (std::abs(left) + std::abs(right));
  if (determinant > error) return 1;
  if (determinant < -error) return -1;
  if (error == 0) return 0;  // points on a line along u or v
  return exact_orientation(a, b, c);
}

}}  // namespace tessera::abi_0_1
