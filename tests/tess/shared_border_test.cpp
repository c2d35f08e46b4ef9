// Patches that share a border's control points share the bits of its vertices, in either direction.

#include "tess/tessellate_support.h"

namespace tessera::test { namespace {

/// Two patches of degrees (m, n) and (k, n) whose borders u = 1 and u = 0 are one net.
struct Neighbours {
  BezierPatch first, second;
};

Neighbours neighbours(Random& random, int m, int k, int n, bool with_weights) {
  const std::vector<Vec3> points = random_points(random, m, n);
  const std::vector<double> weights =
      with_weights ? random_weights(random, m, n, 0.5, 2) : std::vector<double>(points.size(), 1);
  std::vector<Vec3> next = random_points(random, k, n);
  std::vector<double> next_weights =
      with_weights ? random_weights(random, k, n, 0.5, 2) : std::vector<double>(next.size(), 1);
  const std::size_t last_row = static_cast<std::size_t>(m * (n + 1));
  for (std::size_t j = 0; j <= static_cast<std::size_t>(n); ++j) {
    next[j] = points[last_row + j];
    next_weights[j] = weights[last_row + j];
  }
  return {rational(m, n, points, weights), rational(k, n, next, next_weights)};
}

TEST(SharedBorders, AreTheSameBitsInEveryOrientation) {
  Random random(1);
  for (const bool with_weights : {false, true})
    for (const auto& [m, k, n] : {std::array{3, 3, 3}, {1, 2, 1}, {2, 5, 4}, {4, 1, 7}, {3, 3, 15}})
      for (int way = 0; way < 64; ++way) {
        const Neighbours pair = neighbours(random, m, k, n, with_weights);
        const int rate = 1 + way % 9;
        const Mesh mesh = tessellate({reoriented(pair.first, way % 8), reoriented(pair.second, way / 8)}, rate, rate);
        const MeshReport report = good(check(mesh));
        const std::size_t r = static_cast<std::size_t>(rate);
        EXPECT_EQ(report.distinct_positions, 2 * (r + 1) * (r + 1) - (r + 1))
            << "degrees " << m << " " << k << " " << n << ", way " << way << ", rate " << rate << ", " << with_weights;
        EXPECT_EQ(report.open_edges, 6 * r);
        EXPECT_EQ(report.degenerate_triangles, 0u);
      }
}

TEST(SharedBorders, ClosedBodyFarFromZero) {
  // A cube with bulging bicubic faces. Neighbouring faces take their borders from one table of curves.
  Random random(2);
  const Vec3 centre{1e7, -3e6, 5e5};
  const auto corner = [&](int x, int y, int z) { return centre + Vec3{x / 3.0, y / 3.0, z / 3.0}; };
  std::vector<BezierPatch> faces;
  for (int axis = 0; axis < 3; ++axis)
    for (const int side : {0, 3}) {
      std::vector<Vec3> points;
      for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) {
          const int at[3] = {axis == 0   ? side
                             : axis == 1 ? j
                                         : i,
                             axis == 1   ? side
                             : axis == 2 ? j
                                         : i,
                             axis == 2   ? side
                             : axis == 0 ? j
                                         : i};
          const bool inner = i % 3 != 0 && j % 3 != 0;
          points.push_back(corner(at[0], at[1], at[2]) + (inner ? uniform_vector(random, -0.2, 0.2) : Vec3{}));
        }
      faces.push_back(reoriented(polynomial(3, 3, points), static_cast<int>(random() % 8)));
    }
  for (const int rate : {1, 2, 3, 5, 8, 31}) {
    const MeshReport report = good(check(tessellate(faces, rate, rate)));
    EXPECT_TRUE(report.closed()) << rate << ": " << report.open_edges << " open";
    EXPECT_EQ(2 * report.distinct_positions, report.triangles + 4);
    EXPECT_EQ(report.degenerate_triangles, 0u);
  }
}

}}  // namespace tessera::test
