// Edges of faces that share none: which become one, where they are divided, and how they are paired.

#include "tessera/edge_matching.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <random>

#include "support/errors.h"
#include "support/synthetic_sets.h"
#include "tessera/topology.h"

namespace tessera::test {
namespace {

/// Edges by their number of uses; degenerate ones are counted under 0.
using Counts = std::map<std::size_t, std::size_t>;

Counts counts_of(const Shape& shape) {
  EXPECT_TRUE(check_topology(shape).ok()) << check_topology(shape).message();
  const EdgeUses uses = value_of(edge_uses(shape));
  Counts counts;
  for (std::size_t k = 0; k < shape.edges.size(); ++k) ++counts[shape.edges[k].degenerate ? 0 : uses[k].size()];
  return counts;
}

double largest_gap(const Shape& shape) {
  const std::vector<double> gaps = value_of(edge_gaps(shape, 65));
  return gaps.empty() ? 0 : *std::max_element(gaps.begin(), gaps.end());
}

std::size_t closed_count(const Shape& shape) {
  const std::vector<bool> closed = value_of(closed_shells(shape));
  return static_cast<std::size_t>(std::count(closed.begin(), closed.end(), true));
}

/// A bilinear face with the corners in the order around it.
ModelSurface quad(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return {"quad", value_of(BezierPatch::polynomial(1, 1, std::vector<Vec3>{a, d, b, c}))};
}

std::vector<ModelSurface> cube(double size = 1, const Vec3& at = {}) {
  const auto corner = [&](int k) { return at + size * Vec3{double(k & 1), double(k >> 1 & 1), double(k >> 2 & 1)}; };
  std::vector<ModelSurface> faces;
  for (const auto& f : std::array<std::array<int, 4>, 6>{
           {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}})
    faces.push_back(quad(corner(f[0]), corner(f[1]), corner(f[2]), corner(f[3])));
  return faces;
}

TEST(EdgeMatching, SidesOfACubeBecomeTwelveEdges) {
  const Shape shape = value_of(joined_shape(cube(), 1e-3));
  EXPECT_EQ(counts_of(shape), (Counts{{2, 12}}));
  EXPECT_EQ(shape.vertices.size(), 8u);
  EXPECT_EQ(closed_count(shape), 1u);
  EXPECT_EQ(shape.solid_count, 1u);
  EXPECT_EQ(largest_gap(shape), 0);
}

}  // namespace
}  // namespace tessera::test
