#pragma once
// Unevaluated sums of two doubles, about 106 bits, for sums that cancel (Dekker, A floating-point technique for
// extending the available precision, 1971; Ogita, Rump and Oishi, Accurate sum and dot product, 2005).

#include <cmath>

namespace tessera { inline namespace abi_0_1 {

/// The number high + low; |low| is at most half a unit in the last place of high.
struct DoubleDouble {
  double high = 0, low = 0;
  double rounded() const { return high + low; }
};

/// Returns a + b exactly (Knuth).
inline DoubleDouble two_sum(double a, double b) {
  const double sum = a + b, part = sum - a;
  return {sum, (a - (sum - part)) + (b - part)};
}
/// Returns a * b exactly.
inline DoubleDouble two_product(double a, double b) {
  const double product = a * b;
  return {product, std::fma(a, b, -product)};
}
inline DoubleDouble operator+(const DoubleDouble& a, const DoubleDouble& b) {
  const DoubleDouble high = two_sum(a.high, b.high), low = two_sum(a.low, b.low);
  const DoubleDouble sum = two_sum(high.high, high.low + low.high);
  return two_sum(sum.high, sum.low + low.low);
}
inline DoubleDouble operator*(const DoubleDouble& a, double b) {
  const DoubleDouble p = two_product(a.high, b);
  return two_sum(p.high, std::fma(a.low, b, p.low));
}
inline DoubleDouble operator*(const DoubleDouble& a, const DoubleDouble& b) {
  const DoubleDouble p = two_product(a.high, b.high);
  return two_sum(p.high, p.low + (a.high * b.low + a.low * b.high));
}
inline DoubleDouble operator/(const DoubleDouble& a, double b) {
  const double quotient = a.high / b;
  return two_sum(quotient, (std::fma(-quotient, b, a.high) + a.low) / b);
}

}}  // namespace tessera::abi_0_1
