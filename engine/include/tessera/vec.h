#pragma once
// Points and vectors of space, in double.

#include <algorithm>
#include <cmath>
#include <limits>

#pragma GCC visibility push(default)
namespace tessera {

/// A point or a vector. Lengths are in the model's own unit.
struct Vec3 {
  double x = 0, y = 0, z = 0;  ///< in the model's unit

  friend bool operator==(const Vec3&, const Vec3&) = default;                      ///< by components
  Vec3& operator+=(const Vec3& b) { return *this = {x + b.x, y + b.y, z + b.z}; }  ///< by components
};

inline Vec3 operator+(const Vec3& a, const Vec3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec3 operator-(const Vec3& a, const Vec3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec3 operator-(const Vec3& a) { return {-a.x, -a.y, -a.z}; }
inline Vec3 operator*(double s, const Vec3& a) { return {s * a.x, s * a.y, s * a.z}; }
inline Vec3 operator*(const Vec3& a, double s) { return s * a; }
inline double dot(const Vec3& a, const Vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double length(const Vec3& a) { return std::sqrt(dot(a, a)); }
inline bool is_finite(const Vec3& a) { return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z); }
/// The largest absolute component.
inline double max_abs(const Vec3& a) { return std::max({std::abs(a.x), std::abs(a.y), std::abs(a.z)}); }
/// a / |a|, or the zero vector where a is zero.
inline Vec3 normalized(const Vec3& a) {
  const double scale = max_abs(a);
  if (!(scale > 0)) return {};
  const Vec3 b{a.x / scale, a.y / scale, a.z / scale};  // the reciprocal of a subnormal scale is infinite
  return (1 / length(b)) * b;
}

/// An axis-parallel box; empty (lower > upper) by default.
struct Box3 {
  /// Smallest and, below, largest coordinates; an empty box's are infinite.
  Vec3 lower{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
             std::numeric_limits<double>::infinity()};
  /// The largest coordinates.
  Vec3 upper{-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(),
             -std::numeric_limits<double>::infinity()};

  /// Whether no point lies in it.
  bool empty() const { return !(lower.x <= upper.x && lower.y <= upper.y && lower.z <= upper.z); }
  /// So that the point lies in it.
  void extend(const Vec3& p) {
    lower = {std::min(lower.x, p.x), std::min(lower.y, p.y), std::min(lower.z, p.z)};
    upper = {std::max(upper.x, p.x), std::max(upper.y, p.y), std::max(upper.z, p.z)};
  }
  /// So that the box lies in it.
  void extend(const Box3& b) {
    if (b.empty()) return;
    extend(b.lower);
    extend(b.upper);
  }
  Vec3 centre() const { return 0.5 * lower + 0.5 * upper; }  ///< of a box that is not empty
  /// The length of the diagonal; 0 for an empty box. "The size" of a model means this.
  double diagonal() const { return empty() ? 0 : length(upper - lower); }
};

}  // namespace tessera
#pragma GCC visibility pop
