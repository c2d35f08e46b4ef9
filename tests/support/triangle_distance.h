#pragma once
// The distance of a point from a triangle.

#include <algorithm>

#include "tessera/geometry.h"

namespace tessera::test {

inline double distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 edge = b - a;
  const double squared = dot(edge, edge);
  const double t = squared > 0 ? std::clamp(dot(p - a, edge) / squared, 0.0, 1.0) : 0;
  return length(p - (a + t * edge));
}

/// The foot lies inside if it is left of all three edges, seen against the triangle's normal.
inline double distance_to_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const double to_edges =
      std::min({distance_to_segment(p, a, b), distance_to_segment(p, b, c), distance_to_segment(p, c, a)});
  const Vec3 normal = normalized(cross(b - a, c - a));
  const bool inside = dot(cross(b - a, p - a), normal) > 0 && dot(cross(c - b, p - b), normal) > 0 &&
                      dot(cross(a - c, p - c), normal) > 0;
  return inside ? std::min(to_edges, std::abs(dot(p - a, normal))) : to_edges;
}

}  // namespace tessera::test
