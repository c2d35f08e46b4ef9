#pragma once
// Faces without common edges, and what becomes of them.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <utility>
#include <vector>

#include "support/synthetic_sets.h"
#include "tessera/edge_matching.h"
#include "tessera/topology.h"

namespace tessera::test {

/// Edges by their number of uses; degenerate ones are counted under 0.
using Counts = std::map<std::size_t, std::size_t>;

inline Counts counts_of(const Shape& shape) {
  EXPECT_TRUE(check_topology(shape).ok()) << check_topology(shape).message();
  const EdgeUses uses = value_of(edge_uses(shape));
  Counts counts;
  for (std::size_t k = 0; k < shape.edges.size(); ++k) ++counts[shape.edges[k].degenerate ? 0 : uses[k].size()];
  return counts;
}

inline double largest_gap(const Shape& shape) {
  const std::vector<double> gaps = value_of(edge_gaps(shape, 65));
  return gaps.empty() ? 0 : *std::max_element(gaps.begin(), gaps.end());
}

inline std::size_t closed_count(const Shape& shape) {
  const std::vector<bool> closed = value_of(closed_shells(shape));
  return static_cast<std::size_t>(std::count(closed.begin(), closed.end(), true));
}

/// A bilinear face with the corners in the order around it.
inline ModelSurface quad(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return {"quad", value_of(BezierPatch::polynomial(1, 1, std::vector<Vec3>{a, d, b, c}))};
}

inline std::vector<ModelSurface> cube(double size = 1, const Vec3& at = {}) {
  const auto corner = [&](int k) { return at + size * Vec3{double(k & 1), double(k >> 1 & 1), double(k >> 2 & 1)}; };
  std::vector<ModelSurface> faces;
  for (const auto& f : std::array<std::array<int, 4>, 6>{
           {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}})
    faces.push_back(quad(corner(f[0]), corner(f[1]), corner(f[2]), corner(f[3])));
  return faces;
}

inline Curve space_line(const Vec3& from, const Vec3& to) {
  return value_of(Curve::b_spline(1, std::vector<Vec3>{from, to}, std::vector<double>{0, 0, 1, 1}));
}

/// A closed loop of straight lines.
inline TrimLoop space_polygon(const std::vector<Vec3>& points, bool hole = false) {
  TrimLoop loop{{}, hole, {}};
  for (std::size_t k = 0; k < points.size(); ++k)
    loop.curves.push_back(space_line(points[k], points[(k + 1) % points.size()]));
  return loop;
}

inline Shape joined(const std::vector<ModelSurface>& faces, double distance) {
  return value_of(joined_shape(faces, distance));
}

/// The unit square's side at x = 1 as three more squares see it.
inline std::vector<ModelSurface> one_against_three(double a, double b, double gap = 0) {
  const double x = 1 + gap;
  std::vector<ModelSurface> faces{quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0})};
  for (const auto& [from, to] : {std::pair(0.0, a), std::pair(a, b), std::pair(b, 1.0)})
    faces.push_back(quad({x, from, 0}, {2, from, 0}, {2, to, 0}, {x, to, 0}));
  return faces;
}

}  // namespace tessera::test
