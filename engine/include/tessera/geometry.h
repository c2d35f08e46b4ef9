#pragma once
// Points, boxes and affine maps of space; points and rectangles of parameters, and their edges.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#pragma GCC visibility push(default)
namespace tessera { inline namespace abi_0_1 {

/// An id or an index of nothing.
inline constexpr std::uint32_t no_id = 0xffffffff;

/// A point or a vector. Lengths are in the model's own unit.
struct Vec3 {
  double x = 0, y = 0, z = 0;  ///< in the model's unit

  friend bool operator==(const Vec3&, const Vec3&) = default;
  Vec3& operator+=(const Vec3& b) { return *this = {x + b.x, y + b.y, z + b.z}; }
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
/// Returns the Euclidean length.
inline double length(const Vec3& a) { return std::sqrt(dot(a, a)); }
/// Tells whether all components are finite.
inline bool is_finite(const Vec3& a) { return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z); }
/// Returns the largest absolute component.
inline double max_abs(const Vec3& a) { return std::max({std::abs(a.x), std::abs(a.y), std::abs(a.z)}); }
/// Returns a / |a|, or the zero vector if a is zero.
inline Vec3 normalized(const Vec3& a) {
  const double scale = max_abs(a);
  if (!(scale > 0)) return {};
  const Vec3 b{a.x / scale, a.y / scale, a.z / scale};  // the reciprocal of a subnormal scale is infinite
  return (1 / length(b)) * b;
}

/// An axis-parallel box. The default box is empty (lower > upper).
struct Box3 {
  /// The smallest coordinates; infinite in an empty box.
  Vec3 lower{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
             std::numeric_limits<double>::infinity()};
  /// The largest coordinates; -infinite in an empty box.
  Vec3 upper{-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(),
             -std::numeric_limits<double>::infinity()};

  /// Whether the box contains no point.
  bool empty() const { return !(lower.x <= upper.x && lower.y <= upper.y && lower.z <= upper.z); }
  /// Grows the box to contain the point.
  void extend(const Vec3& p) {
    lower = {std::min(lower.x, p.x), std::min(lower.y, p.y), std::min(lower.z, p.z)};
    upper = {std::max(upper.x, p.x), std::max(upper.y, p.y), std::max(upper.z, p.z)};
  }
  /// Grows the box to contain the box b.
  void extend(const Box3& b) {
    if (b.empty()) return;
    extend(b.lower);
    extend(b.upper);
  }
  /// Whether all of the box b, its faces too, lies in this one. False if a bound is NaN.
  bool contains(const Box3& b) const {
    return lower.x <= b.lower.x && lower.y <= b.lower.y && lower.z <= b.lower.z && b.upper.x <= upper.x &&
           b.upper.y <= upper.y && b.upper.z <= upper.z;
  }
  Vec3 centre() const { return 0.5 * lower + 0.5 * upper; }  ///< the box must not be empty
  /// The length of the diagonal; 0 for an empty box. It is the "size" of a model.
  double diagonal() const { return empty() ? 0 : length(upper - lower); }
};

/// The affine map p -> columns[0] p.x + columns[1] p.y + columns[2] p.z + translation.
struct Affine {
  std::array<Vec3, 3> columns{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};  ///< the images of the axes
  Vec3 translation{};                                                        ///< the image of the origin

  static Affine translated(const Vec3& by) { return {.translation = by}; }  ///< moves by a vector
  /// Scales along the axes.
  static Affine scaled(const Vec3& by) { return {.columns = {Vec3{by.x, 0, 0}, Vec3{0, by.y, 0}, Vec3{0, 0, by.z}}}; }
  /// Rotates by `angle` radians about an axis through the origin, counter-clockwise as seen from its tip. A zero axis
  /// gives the identity.
  static Affine rotated(const Vec3& axis, double angle) {
    const Vec3 n = normalized(axis);
    if (n == Vec3{}) return {};
    const double s = std::sin(angle), c = std::cos(angle);
    const auto turned = [&](const Vec3& e) { return c * e + (1 - c) * dot(n, e) * n + s * cross(n, e); };  // Rodrigues
    return {.columns = {turned({1, 0, 0}), turned({0, 1, 0}), turned({0, 0, 1})}};
  }

  /// Returns the image of a direction, without the translation.
  Vec3 vector(const Vec3& d) const { return d.x * columns[0] + d.y * columns[1] + d.z * columns[2]; }
  Vec3 point(const Vec3& p) const { return vector(p) + translation; }  ///< the image of a point
  /// Returns a bound of |vector(d)| / |d|: the root of the largest row sum of |M^T M|. It is sharp for orthogonal
  /// columns.
  double norm_bound() const {
    const double scale = std::max({max_abs(columns[0]), max_abs(columns[1]), max_abs(columns[2])});
    if (!(scale > 0)) return 0;
    const auto scaled = [scale](const Vec3& a) { return Vec3{a.x / scale, a.y / scale, a.z / scale}; };  // squares fit
    double largest = 0;
    for (const Vec3& a : columns) {
      double row = 0;
      for (const Vec3& b : columns) row += std::abs(dot(scaled(a), scaled(b)));
      largest = std::max(largest, row);
    }
    return scale * std::sqrt(largest);
  }
  /// The factor by which volumes grow; negative if the map mirrors.
  double determinant() const { return dot(columns[0], cross(columns[1], columns[2])); }

  /// Applies b first, then a.
  friend Affine operator*(const Affine& a, const Affine& b) {
    return {.columns = {a.vector(b.columns[0]), a.vector(b.columns[1]), a.vector(b.columns[2])},
            .translation = a.point(b.translation)};
  }
  friend bool operator==(const Affine&, const Affine&) = default;
};

/// Tells whether all numbers of the map are finite.
inline bool is_finite(const Affine& map) {
  return is_finite(map.columns[0]) && is_finite(map.columns[1]) && is_finite(map.columns[2]) &&
         is_finite(map.translation);
}

/// A point in the plane of a surface's parameters.
struct ParameterPoint {
  double u = 0, v = 0;  ///< in the surface's own parameters

  friend bool operator==(const ParameterPoint&, const ParameterPoint&) = default;  ///< by both coordinates
};
/// Tells whether both parameters are finite.
inline bool is_finite(const ParameterPoint& p) { return std::isfinite(p.u) && std::isfinite(p.v); }

/// The rectangle [u0, u1] x [v0, v1] of parameters, u0 < u1 and v0 < v1.
struct Domain {
  double u0 = 0, u1 = 1, v0 = 0, v1 = 1;  ///< u0 < u1, v0 < v1

  /// Maps a local parameter in [0,1] to u of this rectangle; exact at 0 and 1.
  double u_at(double s) const { return s == 1 ? u1 : u0 + s * (u1 - u0); }
  double v_at(double t) const { return t == 1 ? v1 : v0 + t * (v1 - v0); }  ///< like u_at, for v
  /// Maps u of this rectangle to a local parameter; exact at u0 and u1.
  double local_u(double u) const { return u == u1 ? 1 : (u - u0) / (u1 - u0); }
  double local_v(double v) const { return v == v1 ? 1 : (v - v0) / (v1 - v0); }                 ///< like local_u, for v
  bool contains(double u, double v) const { return u >= u0 && u <= u1 && v >= v0 && v <= v1; }  ///< borders included

  friend bool operator==(const Domain&, const Domain&) = default;
};

/// A side of a patch, counter-clockwise around its parameters from (0,0): v = 0, u = 1, v = 1, u = 0.
enum class Side : std::uint8_t { v0, u1, v1, u0 };

/// A set of sides.
struct SideMask {
  std::uint8_t bits = 0;  ///< bit k: the side whose value is k
  /// Whether the set contains the side.
  bool has(Side side) const { return (bits >> static_cast<int>(side) & 1) != 0; }
  /// Adds the side to the set.
  void add(Side side) { bits = static_cast<std::uint8_t>(bits | 1 << static_cast<int>(side)); }
  bool any() const { return bits != 0; }  ///< whether the set contains a side

  friend bool operator==(const SideMask&, const SideMask&) = default;
};

}}  // namespace tessera::abi_0_1
#pragma GCC visibility pop
