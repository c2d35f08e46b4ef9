#pragma once
// The largest of numbers, with one answer in any order.

#include <cmath>
#include <limits>

namespace tessera { inline namespace abi_0_1 {

/// Returns the larger number. NaN counts as the largest, whatever its bits, and 0 is larger than -0. So the largest of
/// several numbers has the same bits in any order.
inline double larger_of(double a, double b) {
  if (std::isnan(a) || std::isnan(b)) return std::numeric_limits<double>::quiet_NaN();
  if (a == b) return std::signbit(a) ? b : a;
  return a > b ? a : b;
}

}}  // namespace tessera::abi_0_1
