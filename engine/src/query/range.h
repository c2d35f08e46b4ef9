#pragma once
// Ranges of numbers without directed rounding, for bounds that have a margin of their own.

#include <algorithm>
#include <cmath>

#include "base/infinity.h"
#include "tessera/geometry.h"

namespace tessera { inline namespace abi_0_1 {

/// The numbers from lower to upper; empty by default.
struct Range {
  double lower = infinity, upper = -infinity;

  void extend(double x) { lower = std::min(lower, x), upper = std::max(upper, x); }
  Range widened(double by) const { return {lower - by, upper + by}; }
  double magnitude() const { return std::max(std::abs(lower), std::abs(upper)); }
};

inline Range operator+(const Range& a, const Range& b) { return {a.lower + b.lower, a.upper + b.upper}; }
inline Range operator*(double s, const Range& a) {
  return s >= 0 ? Range{s * a.lower, s * a.upper} : Range{s * a.upper, s * a.lower};
}
inline Range operator*(const Range& a, const Range& b) {
  const double p = a.lower * b.lower, q = a.lower * b.upper, r = a.upper * b.lower, s = a.upper * b.upper;
  return {std::min(std::min(p, q), std::min(r, s)), std::max(std::max(p, q), std::max(r, s))};
}
/// Returns a / b for b > 0.
inline Range divided(const Range& a, const Range& b) {
  return {a.lower / (a.lower < 0 ? b.lower : b.upper), a.upper / (a.upper > 0 ? b.lower : b.upper)};
}

/// The vectors of a box, component by component.
struct VectorRange {
  Range x, y, z;

  void extend(const Vec3& p) { x.extend(p.x), y.extend(p.y), z.extend(p.z); }
  /// Returns the range of the vectors' shares along a direction.
  Range along(const Vec3& d) const { return d.x * x + d.y * y + d.z * z; }
  double magnitude() const { return std::hypot(x.magnitude(), y.magnitude(), z.magnitude()); }
};

inline VectorRange operator+(const VectorRange& a, const VectorRange& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline VectorRange operator*(const Range& s, const VectorRange& a) { return {s * a.x, s * a.y, s * a.z}; }
inline VectorRange operator*(double s, const VectorRange& a) { return {s * a.x, s * a.y, s * a.z}; }
inline VectorRange divided(const VectorRange& a, const Range& w) {
  return {divided(a.x, w), divided(a.y, w), divided(a.z, w)};
}

}}  // namespace tessera::abi_0_1
