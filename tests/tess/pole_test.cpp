// Collapsed edges: the triangles that collapse with them are left out, and no others.

#include "tess/tessellate_support.h"

namespace tessera::test { namespace {

/// A random patch with any set of sides collapsed: bit k is the side whose value is k.
BezierPatch with_collapsed_sides(Random& random, int m, int n, int sides, bool with_weights) {
  std::vector<Vec3> points = random_points(random, m, n);
  const Vec3 joint = uniform_vector(random, -1, 1);
  std::array<Vec3, 4> pole;
  for (Vec3& p : pole) p = uniform_vector(random, -1, 1);
  const bool meet = (sides & 5) && (sides & 10);  // sides that meet collapse to one point, and pull the others along
  for (int i = 0; i <= m; ++i)
    for (int j = 0; j <= n; ++j) {
      const bool on[4] = {j == 0, i == m, j == n, i == 0};
      for (std::size_t e = 0; e < 4; ++e)
        if ((sides >> e & 1) && on[e]) points[static_cast<std::size_t>(i * (n + 1) + j)] = meet ? joint : pole[e];
    }
  return rational(m, n, points,
                  with_weights ? random_weights(random, m, n, 0.5, 2) : std::vector<double>(points.size(), 1));
}

/// Triangles of the whole grid that have three distinct corners.
std::size_t sound_triangles_of_full_grid(Mesh mesh, int rate_u, int rate_v) {
  mesh.indices.clear();
  mesh.patches.clear();
  const std::uint32_t row = static_cast<std::uint32_t>(rate_v) + 1;
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(rate_u); ++i)
    for (std::uint32_t j = 0; j + 1 < row; ++j) {
      const std::uint32_t k = i * row + j;
      mesh.indices.insert(mesh.indices.end(), {k, k + row, k + row + 1, k, k + row + 1, k + 1});
    }
  const MeshReport report = good(check(mesh));
  return report.triangles - report.degenerate_triangles;
}

TEST(Poles, LeaveOutWhatCollapsesAndNothingElse) {
  Random random(1);
  for (int sides = 0; sides < 16; ++sides)
    for (const bool with_weights : {false, true})
      for (const auto& [u, v] : {std::pair{1, 1}, {1, 2}, {2, 1}, {1, 4}, {2, 2}, {3, 2}, {4, 1}, {5, 5}}) {
        const BezierPatch patch = with_collapsed_sides(random, 3, 4, sides, with_weights);
        ASSERT_EQ(int{patch.collapsed_sides().bits}, sides);
        const Mesh mesh = tessellate({patch}, u, v);
        EXPECT_EQ(good(check(mesh)).degenerate_triangles, 0u) << sides << " " << u << "x" << v << " " << with_weights;
        EXPECT_EQ(mesh.triangle_count(), sound_triangles_of_full_grid(mesh, u, v)) << sides << " " << u << "x" << v;
      }
}

TEST(Poles, CostOneTriangleACell) {
  Random random(2);
  for (int side = 0; side < 4; ++side) {
    const BezierPatch patch = with_collapsed_sides(random, 3, 3, 1 << side, false);
    const std::size_t along = side % 2 == 1 ? 7 : 5;  // cells at the pole
    EXPECT_EQ(tessellate({patch}, 5, 7).triangle_count(), 2 * 5 * 7 - along);
  }
}

TEST(Poles, NormalsThereAreLimits) {
  Random random(3);
  const BezierPatch patch = with_collapsed_sides(random, 3, 3, 8, false);
  const Mesh mesh = tessellate({patch}, 4, 4);
  for (std::size_t j = 0; j <= 4; ++j) {
    const Vec3 normal{mesh.normals[3 * j], mesh.normals[3 * j + 1], mesh.normals[3 * j + 2]};
    EXPECT_LT(length(normal - unit_normal(patch, 0, static_cast<double>(j) / 4).direction), 1e-4) << j;
  }
}

TEST(Poles, PointsAndCurvesHaveNoTriangles) {
  Random random(4);
  const std::vector<Vec3> curve = random_points(random, 3, 0);
  std::vector<Vec3> point(16, curve[0]), swept;
  for (std::size_t i = 0; i < 4; ++i) swept.insert(swept.end(), 4, curve[i]);
  const std::vector<double> weights = random_weights(random, 3, 3, 0.5, 2);
  const BezierPatch line = polynomial(3, 3, swept);
  for (const BezierPatch& patch : {polynomial(3, 3, point), rational(3, 3, point, weights), line, transposed(line)})
    for (const int rate : {1, 2, 5}) EXPECT_EQ(tessellate({patch}, rate, rate).triangle_count(), 0u);
  // With different weights, the same points span an area.
  EXPECT_GT(tessellate({rational(3, 3, swept, weights)}, 4, 4).triangle_count(), 0u);
  // Between others, such a patch takes vertices and no triangles.
  const BezierPatch regular = random_polynomial(random, 2, 2);
  const Mesh mesh = tessellate({regular, line, regular}, 3, 3);
  EXPECT_EQ(mesh.vertex_count(), 3u * 16);
  EXPECT_EQ(mesh.triangle_count(), 2u * 18);
  EXPECT_EQ(mesh.patches[17], 0u);
  EXPECT_EQ(mesh.patches[18], 2u);
  EXPECT_EQ(mesh.indices[3 * 18], 32u);
}

/// The sphere as eight rational octants, with poles at +z and -z, all r_u x r_v inwards.
std::vector<BezierPatch> sphere() {
  const double h = std::sqrt(0.5), w[] = {1, h, 1};
  const Vec3 octant[] = {{1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {1, 0, 1}, {1, 1, 1},
                         {0, 1, 1}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
  std::vector<double> weights;
  for (const double a : w)
    for (const double b : w) weights.push_back(a * b);
  std::vector<BezierPatch> patches;
  for (int signs = 0; signs < 8; ++signs) {
    const double x = signs & 1 ? -1 : 1, y = signs & 2 ? -1 : 1, z = signs & 4 ? -1 : 1;
    std::vector<Vec3> points;
    for (const Vec3& p : octant) points.push_back({x * p.x, y * p.y, z * p.z});
    const BezierPatch patch = rational(2, 2, points, weights);
    patches.push_back(x * y * z > 0 ? patch : transposed(patch));
  }
  return patches;
}

TEST(Poles, SphereIsClosedAndConsistent) {
  for (const int rate : {1, 2, 3, 4, 5, 16, 37}) {
    const Mesh mesh = tessellate(sphere(), rate, rate);
    const MeshReport report = good(check(mesh));
    EXPECT_TRUE(report.closed()) << rate << ": " << report.open_edges << " open";
    EXPECT_EQ(report.inconsistent_edges, 0u);
    EXPECT_EQ(report.degenerate_triangles, 0u);
    EXPECT_EQ(report.non_finite_vertices, 0u);
    EXPECT_EQ(mesh.triangle_count(), 8u * static_cast<std::size_t>(2 * rate * rate - rate));
    EXPECT_EQ(2 * report.distinct_positions, report.triangles + 4);  // Euler: V - 3/2 F + F = 2
    double volume = 0;
    for (std::size_t k = 0; k < mesh.triangle_count(); ++k) {
      const auto corner = [&](std::size_t c) {
        const float* p = &mesh.positions[3 * mesh.indices[3 * k + c]];
        return Vec3{p[0], p[1], p[2]};
      };
      volume -= dot(corner(0), cross(corner(1), corner(2))) / 6;  // the faces look inwards
    }
    EXPECT_LT(volume, 4.18880);
    EXPECT_GT(volume, 4.18879 * (1 - 2.0 / (rate * rate)));
  }
}

}}  // namespace tessera::test
