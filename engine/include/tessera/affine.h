#pragma once
// Affine maps of space.

#include <algorithm>
#include <array>
#include <cmath>

#include "tessera/vec.h"

#pragma GCC visibility push(default)
namespace tessera {

/// p -> columns[0] p.x + columns[1] p.y + columns[2] p.z + translation.
struct Affine {
  std::array<Vec3, 3> columns{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};  ///< the images of the axes
  Vec3 translation{};                                                        ///< the image of the origin

  static Affine translated(const Vec3& by) { return {.translation = by}; }  ///< moves by a vector
  /// Stretches along the axes.
  static Affine scaled(const Vec3& by) { return {.columns = {Vec3{by.x, 0, 0}, Vec3{0, by.y, 0}, Vec3{0, 0, by.z}}}; }
  /// By `angle` radians about an axis through the origin, counter-clockwise as seen from its tip. The identity for an
  /// axis of no length.
  static Affine rotated(const Vec3& axis, double angle) {
    const Vec3 n = normalized(axis);
    if (n == Vec3{}) return {};
    const double s = std::sin(angle), c = std::cos(angle);
    const auto turned = [&](const Vec3& e) { return c * e + (1 - c) * dot(n, e) * n + s * cross(n, e); };  // Rodrigues
    return {.columns = {turned({1, 0, 0}), turned({0, 1, 0}), turned({0, 0, 1})}};
  }

  /// The image of a direction: the translation has no part in it.
  Vec3 vector(const Vec3& d) const { return d.x * columns[0] + d.y * columns[1] + d.z * columns[2]; }
  Vec3 point(const Vec3& p) const { return vector(p) + translation; }  ///< the image of a point
  /// A bound of |vector(d)| / |d|, sharp where the columns are orthogonal: the root of the largest row sum of M^T M.
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
  /// How volumes grow; negative where the map mirrors.
  double determinant() const { return dot(columns[0], cross(columns[1], columns[2])); }

  /// First b, then a.
  friend Affine operator*(const Affine& a, const Affine& b) {
    return {.columns = {a.vector(b.columns[0]), a.vector(b.columns[1]), a.vector(b.columns[2])},
            .translation = a.point(b.translation)};
  }
  friend bool operator==(const Affine&, const Affine&) = default;  ///< the same numbers
};

inline bool is_finite(const Affine& map) {
  return is_finite(map.columns[0]) && is_finite(map.columns[1]) && is_finite(map.columns[2]) &&
         is_finite(map.translation);
}

}  // namespace tessera
#pragma GCC visibility pop
