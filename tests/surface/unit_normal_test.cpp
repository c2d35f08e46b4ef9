// Unit normals, above all where r_u x r_v vanishes.

#include "support/random_patches.h"
#include "support/reference.h"
#include "support/ulp.h"

namespace tessera::test { namespace {

constexpr Vec3 pole{0.25, -0.5, 1};

/// A random patch whose row u = 0 is one point.
BezierPatch random_pole_patch(Random& random, int m, int n, bool with_weights) {
  std::vector<Vec3> points = random_points(random, m, n);
  for (int j = 0; j <= n; ++j) points[static_cast<std::size_t>(j)] = pole;
  return rational(m, n, points,
                  with_weights ? random_weights(random, m, n, 0.5, 2) : std::vector<double>(points.size(), 1));
}

/// Moves the parameter from (u,v) a little further inside the patch along one direction.
double inside(double t, double step) { return t < 0.5 ? t + step : t - step; }

TEST(UnitNormal, RegularPointsAgreeWithTheDefinition) {
  Random random(1);
  for (int m = 1; m <= max_degree; ++m)
    for (int n = 1; n <= max_degree; ++n)
      for (const BezierPatch& patch : {random_polynomial(random, m, n), random_rational(random, m, n)}) {
        const double u = uniform(random, 0, 1), v = uniform(random, 0, 1);
        const UnitNormal normal = unit_normal(patch, u, v);
        EXPECT_EQ(normal.kind, NormalKind::regular);
        EXPECT_NEAR(length(normal.direction), 1, 2 * double_unit);
        EXPECT_LT(max_abs(normal.direction - reference_normal(patch, u, v)), 1e-11) << m << " " << n;
      }
}

TEST(UnitNormal, LimitAtACollapsedEdgeOfAnyOrientation) {
  Random random(2);
  for (const bool with_weights : {false, true})
    for (const auto& [m, n] : {std::pair{3, 3}, {1, 2}, {2, 5}, {4, 1}, {9, 7}}) {
      const BezierPatch upright = random_pole_patch(random, m, n, with_weights);
      for (int way = 0; way < 8; ++way) {
        const BezierPatch patch = reoriented(upright, way);
        const SideMask edges = patch.collapsed_sides();
        ASSERT_TRUE(edges.any());
        const bool along_u = edges.has(Side::u0) || edges.has(Side::u1);
        const double end = edges.has(Side::u1) || edges.has(Side::v1) ? 1 : 0;
        for (const double across : {0.0, 0.125, 0.3, 0.5, 0.77, 1.0}) {
          const double u = along_u ? end : across, v = along_u ? across : end, step = 1e-7;
          const UnitNormal normal = unit_normal(patch, u, v);
          EXPECT_EQ(normal.kind, NormalKind::limit) << way << " " << across;
          const Vec3 sampled = reference_normal(patch, along_u ? inside(u, step) : u, along_u ? v : inside(v, step));
          EXPECT_LT(length(normal.direction - sampled), 1e-4) << "way " << way << " at " << u << ", " << v;
        }
      }
    }
}

TEST(UnitNormal, ConvergesTowardsAPole) {
  Random random(3);
  for (const bool with_weights : {false, true}) {
    const BezierPatch patch = random_pole_patch(random, 3, 3, with_weights);
    const Vec3 limit = unit_normal(patch, 0, 0.4).direction;
    for (double u = 1e-5; u > 1e-300; u *= 1e-3) {
      const UnitNormal normal = unit_normal(patch, u, 0.4);
      EXPECT_NE(normal.kind, NormalKind::undefined) << u;
      EXPECT_LT(length(normal.direction - limit), 1e3 * u + 1e-12) << u;
    }
  }
}

TEST(UnitNormal, LidOfATeapot) {
  // A quarter of a lid: a flat ring about the knob's top, the same on all four sides, so one normal at the pole.
  const double k = 0.5522847498, r = 0.4;
  std::vector<Vec3> points;
  for (int row = 0; row < 4; ++row) {
    const double radius = row * r, height = row == 3 ? 0.5 : 1;
    for (const Vec3& p : {Vec3{1, 0, 0}, Vec3{1, k, 0}, Vec3{k, 1, 0}, Vec3{0, 1, 0}})
      points.push_back(radius * p + Vec3{0, 0, height});
  }
  const BezierPatch lid = polynomial(3, 3, points);
  for (int j = 0; j <= 32; ++j) {
    const UnitNormal normal = unit_normal(lid, 0, j / 32.0);
    EXPECT_EQ(normal.kind, NormalKind::limit);
    EXPECT_EQ(normal.direction, (Vec3{0, 0, 1}));
  }
}

TEST(UnitNormal, DoesNotDependOnSizeOrPlace) {
  Random random(4);
  for (const bool with_weights : {false, true}) {
    const BezierPatch patch = random_pole_patch(random, 3, 2, with_weights);
    for (const double size : {1e-290, 1e-100, 1e-6, 1e-3, 1e3, 1e6, 1e100, 1e300})
      for (const double offset : {0.0, 100.0}) {
        std::vector<Vec3> points;
        std::vector<double> weights;
        for (std::size_t k = 0; k < patch.points().size(); ++k) {
          points.push_back(size * (patch.points()[k] + Vec3{offset, offset, offset}));
          weights.push_back(with_weights ? patch.weights()[k] : 1);
        }
        const BezierPatch scaled = rational(3, 2, points, weights);
        for (const double u : {0.0, 1e-9, 0.4, 1.0}) {
          const UnitNormal a = unit_normal(patch, u, 0.3), b = unit_normal(scaled, u, 0.3);
          EXPECT_EQ(a.kind, b.kind) << size << " " << u;
          EXPECT_LT(length(a.direction - b.direction), offset > 0 ? 1e-10 : 1e-12) << size << " " << u;
        }
      }
  }
}

TEST(UnitNormal, ThinPatchesAreRegular) {
  Random random(5);
  for (const double thickness : {1e-3, 1e-9, 1e-12, 1e-100}) {
    std::vector<Vec3> points;
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j) points.push_back({thickness * i, j + 0.1 * thickness * i * j, 0});
    for (Vec3& p : points) p.z = 0.01 * thickness * p.y;
    const UnitNormal normal = unit_normal(polynomial(3, 3, points), 0.3, 0.6);
    EXPECT_EQ(normal.kind, NormalKind::regular) << thickness;
    EXPECT_NEAR(normal.direction.z, 1, 1e-3);
  }
}

TEST(UnitNormal, ParallelTangentsAtACorner) {
  // V_00, V_10 and V_01 on one line. In a plane both sides agree; bent out of it they need not.
  const auto corner = [](double height) {
    return polynomial(
        2, 2,
        {{0, 0, 0}, {2, 0, 0}, {4, 3, 0}, {1, 0, 0}, {3, -1, 0}, {5, 1, 1}, {2, -3, height}, {5, -3, 0}, {7, 0, 0}});
  };
  const UnitNormal flat = unit_normal(corner(0), 0, 0);
  EXPECT_EQ(flat.kind, NormalKind::limit);
  EXPECT_LT(length(flat.direction - reference_normal(corner(0), 1e-7, 1e-7)), 1e-5);
  EXPECT_EQ(unit_normal(corner(1), 0, 0).kind, NormalKind::undefined);
  EXPECT_EQ(unit_normal(corner(1), 0, 0).direction, Vec3{});
}

TEST(UnitNormal, FoldsHaveNone) {
  // A plane folded back along u = 1/2: the normal turns over there.
  std::vector<Vec3> points;
  for (const double x : {0.0, 1.0, 0.0})
    for (const double y : {0.0, 1.0}) points.push_back({x, y, 0});
  const BezierPatch fold = polynomial(2, 1, points);
  EXPECT_EQ(unit_normal(fold, 0.25, 0.5).direction, (Vec3{0, 0, 1}));
  EXPECT_EQ(unit_normal(fold, 0.75, 0.5).direction, (Vec3{0, 0, -1}));
  EXPECT_EQ(unit_normal(fold, 0.5, 0.5).kind, NormalKind::undefined);
}

TEST(UnitNormal, CurvesAndPointsHaveNone) {
  Random random(6);
  const std::vector<Vec3> curve = random_points(random, 2, 0);
  const std::vector<double> curve_weights = {1, 0.6, 1.7}, any_weights = random_weights(random, 2, 2, 0.5, 2);
  std::vector<Vec3> points, line;
  std::vector<double> weights;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) {
      points.push_back(curve[i]);
      weights.push_back(curve_weights[i]);
      line.push_back((static_cast<double>(i) + 2 * static_cast<double>(j * j)) * pole);
    }
  for (const BezierPatch& patch :
       {polynomial(2, 2, points), rational(2, 2, points, weights), transposed(rational(2, 2, points, weights)),
        polynomial(2, 2, line), rational(2, 2, line, any_weights), polynomial(2, 2, std::vector<Vec3>(9, pole)),
        rational(2, 2, std::vector<Vec3>(9, pole), any_weights)})
    for (const double u : {0.0, 0.3, 0.5, 1.0})
      for (const double v : {0.0, 0.5, 0.9, 1.0}) {
        const UnitNormal normal = unit_normal(patch, u, v);
        EXPECT_EQ(normal.kind, NormalKind::undefined) << u << " " << v;
        EXPECT_EQ(normal.direction, Vec3{});
      }
}

TEST(UnitNormal, TwoCollapsedEdgesAtACorner) {
  Random random(7);
  std::vector<Vec3> points = random_points(random, 3, 3);
  for (std::size_t k = 0; k < 4; ++k) points[k] = points[4 * k] = pole;
  const BezierPatch patch = polynomial(3, 3, points);
  EXPECT_EQ(unit_normal(patch, 0, 0).kind, NormalKind::undefined);
  EXPECT_EQ(unit_normal(patch, 0, 0.5).kind, NormalKind::limit);
  EXPECT_EQ(unit_normal(patch, 0.5, 0).kind, NormalKind::limit);
  EXPECT_EQ(unit_normal(patch, 1, 0).kind, NormalKind::limit);
  EXPECT_EQ(unit_normal(patch, 1, 1).kind, NormalKind::regular);
}

}}  // namespace tessera::test
