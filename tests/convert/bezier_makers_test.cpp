// Ruled patches, cylinders, cones and hyperbolic paraboloids.

#include "support/errors.h"
#include "support/random_patches.h"
#include "support/reference.h"
#include "support/synthetic_sets.h"
#include "support/ulp.h"
#include "tessera/bezier_operations.h"

namespace tessera::test { namespace {

const double half_root = std::sqrt(0.5);
const BezierPolygon quarter_circle{{{1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {1, half_root, 1}};

BezierPolygon random_curve(Random& random, int degree) { return {random_points(random, degree, 0), {}}; }

TEST(BezierMakers, RuledPatchesAreStraightAlongU) {
  Random random(1);
  for (const auto& [m, n] : {std::pair{1, 1}, {3, 3}, {2, 5}, {9, 4}, {15, 1}}) {
    const BezierPolygon c0 = random_curve(random, m), c1 = random_curve(random, n);
    const BezierPatch patch = value_of(make_ruled(c0, c1));
    EXPECT_EQ(patch.degree_u(), 1);
    EXPECT_EQ(patch.degree_v(), std::max(m, n));
    const BezierPatch flat0 = value_of(make_ruled(c0, c0)), flat1 = value_of(make_ruled(c1, c1));
    for (const double u : {0.0, 0.25, 1.0})
      for (const double v : {0.0, 0.6, 1.0}) {
        const Vec3 expected = (1 - u) * reference_position(flat0, 0, v) + u * reference_position(flat1, 0, v);
        EXPECT_TRUE(within_units(reference_position(patch, u, v), expected, double_unit, 4));
      }
  }
}

TEST(BezierMakers, RuledBetweenArcsOfTheSameWeights) {
  BezierPolygon above = quarter_circle;
  for (Vec3& p : above.points) p = {2 * p.x, 2 * p.y, 1};
  const BezierPatch frustum = value_of(make_ruled(quarter_circle, above));
  for (int k = 0; k <= 16; ++k)
    for (const double u : {0.0, 0.3, 1.0}) {
      const Vec3 p = reference_position(frustum, u, k / 16.0);
      EXPECT_NEAR(std::hypot(p.x, p.y), 1 + u, 4 * double_unit);
      EXPECT_NEAR(p.z, u, double_unit);
    }
}

TEST(BezierMakers, CylinderHasParallelRulings) {
  const Vec3 direction{0, 1, 3};
  const BezierPatch patch = value_of(make_cylinder(quarter_circle, direction));
  for (int j = 0; j <= 2; ++j) EXPECT_EQ(patch.point(1, j) - patch.point(0, j), direction);
  for (const double u : {0.0, 0.4, 1.0})
    for (int k = 0; k <= 16; ++k) {
      const SurfaceJet jet = evaluate_jet(patch, u, k / 16.0);
      EXPECT_TRUE(within_units(jet.du, direction, 4 * double_unit, 4));
      const Vec3 foot = jet.position - u * direction;
      EXPECT_NEAR(std::hypot(foot.x, foot.y), 1, 8 * double_unit);
    }
}

TEST(BezierMakers, ConeHasAPole) {
  const Vec3 apex{0, 0, 2};
  const BezierPatch patch = value_of(make_cone(apex, quarter_circle));
  EXPECT_TRUE(patch.collapsed_sides().has(Side::u0));
  for (const double u : {0.0, 0.4, 1.0})
    for (int k = 0; k <= 16; ++k) {
      const Vec3 p = reference_position(patch, u, k / 16.0);
      EXPECT_NEAR(std::hypot(p.x, p.y), u, 4 * double_unit);
      EXPECT_NEAR(p.z, 2 - 2 * u, 4 * double_unit);
    }
}

TEST(BezierMakers, HyperbolicParaboloid) {
  const BezierPatch patch = value_of(make_hyperbolic_paraboloid({0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 2}));
  for (const double u : {0.0, 0.25, 1.0})
    for (const double v : {0.0, 0.75, 1.0}) EXPECT_EQ(de_casteljau(patch, u, v), (Vec3{u, v, 2 * u * v}));
}

TEST(BezierMakers, RefuseBadCurves) {
  Random random(2);
  const BezierPolygon line = random_curve(random, 1), long_curve = random_curve(random, 16);
  expect_refused(make_ruled(line, long_curve), StatusCode::unsupported_degree, -1,
                 "a curve has 2 to 16 points, found 17");
  expect_refused(make_cylinder({{{}}, {}}, {1, 0, 0}), StatusCode::unsupported_degree, -1, "found 1");
  expect_refused(make_cone({}, {}), StatusCode::unsupported_degree, -1, "found 0");
  expect_refused(make_cylinder(line, {}), StatusCode::invalid_argument, -1, "cylinder is zero");
  expect_refused(make_cylinder(line, {0, not_a_number, 0}), StatusCode::non_finite, 2, "control point [1][0]");
  expect_refused(make_cone({infinity, 0, 0}, line), StatusCode::non_finite, 0, "control point [0][0]");
  expect_refused(make_ruled(line, quarter_circle), StatusCode::unsupported, -1, "different weights");
  BezierPolygon bad = quarter_circle;
  bad.weights[1] = 0;
  expect_refused(make_ruled(bad, random_curve(random, 3)), StatusCode::invalid_weight, 1, "weight [0][1] is 0");
  expect_refused(make_cone({}, bad), StatusCode::invalid_weight, 1, "weight [0][1] is 0");
  bad.weights.pop_back();
  expect_refused(make_cylinder(bad, {0, 0, 1}), StatusCode::count_mismatch, -1,
                 "a curve of 3 points has 3 weights or none, found 2");
  expect_refused(make_hyperbolic_paraboloid({}, {}, {}, {0, 0, not_a_number}), StatusCode::non_finite, 3, "[1][1]");
}

}}  // namespace tessera::test
