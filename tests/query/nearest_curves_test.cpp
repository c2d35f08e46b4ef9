// Nearest points of curves: closed formulas, random curves beside dense samples, wrong input.

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <numbers>

#include "support/random_patches.h"
#include "support/ray_classes.h"
#include "tessera/nearest_curves.h"

namespace tessera::test { namespace {

/// A full circle of radius 1 around z as four rational quadratic arcs.
Curve circle() {
  const double w = std::numbers::sqrt2 / 2;
  const std::vector<Vec3> points{{1, 0, 0},   {1, 1, 0},  {0, 1, 0},  {-1, 1, 0}, {-1, 0, 0},
                                 {-1, -1, 0}, {0, -1, 0}, {1, -1, 0}, {1, 0, 0}};
  const std::vector<double> weights{1, w, 1, w, 1, w, 1, w, 1};
  const std::vector<double> knots{0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4};
  return value_of(Curve::nurbs(2, points, weights, knots));
}

TEST(NearestCurves, OfACircle) {
  const std::vector<Curve> curves{circle()};
  const CurveScene scene = value_of(CurveScene::make(curves));
  Random random(2);
  for (int k = 0; k < 2000; ++k) {
    const double size = rays::power(random, 1e-3, 1e6);
    const Vec3 point = size * uniform_vector(random, -1, 1);
    const NearestCurvePoint found = scene.nearest(point);
    ASSERT_EQ(found.kind, NearestKind::found);
    // Beside the axis the circle is nearly as far away all along.
    EXPECT_TRUE(found.flags.certified || std::hypot(point.x, point.y) < 0.01) << point.x << ' ' << point.y;
    EXPECT_FALSE(found.flags.border);
    EXPECT_NEAR(found.distance, std::hypot(std::hypot(point.x, point.y) - 1, point.z), 4e-15 * (1 + size));
    EXPECT_LE(length(position(curves[0], found.t) - found.position), 1e-14);
  }
}

TEST(NearestCurves, FromTheMiddleOfACircle) {
  std::vector<Curve> curves{circle()};
  const NearestCurvePoint alone = value_of(CurveScene::make(curves)).nearest({0, 0, 0});
  EXPECT_NEAR(alone.distance, 1, 1e-14);
  EXPECT_TRUE(alone.flags.ambiguous);
  curves.push_back(value_of(Curve::bezier(std::vector<Vec3>{{0.9, 0, 0}, {3, 0, 0}})));
  const NearestCurvePoint nearer = value_of(CurveScene::make(curves)).nearest({0, 0, 0});
  EXPECT_EQ(nearer.curve, 1u);
  EXPECT_DOUBLE_EQ(nearer.distance, 0.9);
  EXPECT_TRUE(nearer.flags.border);
  EXPECT_FALSE(nearer.flags.ambiguous);
}

/// A random spline with corners or a tight loop here and there.
Curve random_curve(Random& random, bool is_rational) {
  const int degree = 1 + static_cast<int>(random() % 5);
  std::vector<Vec3> points;
  std::vector<double> weights, knots;
  const int count = degree + 1 + static_cast<int>(random() % 8);
  Vec3 at = uniform_vector(random, -1, 1);
  for (int k = 0; k < count; ++k) {
    at += rays::power(random, 1e-6, 0.7) * uniform_vector(random, -1, 1);
    points.push_back(at);
    weights.push_back(rays::power(random, 0.1, 10));
  }
  for (int k = 0; k < count + degree + 1; ++k) knots.push_back(std::clamp(k - degree, 0, count - degree));
  return is_rational ? value_of(Curve::nurbs(degree, points, weights, knots))
                     : value_of(Curve::b_spline(degree, points, knots));
}

TEST(NearestCurves, NothingIsNearer) {
  Random random(5);
  for (int round = 0; round < 40; ++round) {
    std::vector<Curve> curves;
    for (int k = 0; k < 3; ++k) curves.push_back(random_curve(random, round % 2 == 1));
    const CurveScene scene = value_of(CurveScene::make(curves));
    std::vector<Vec3> samples;
    for (const Curve& curve : curves)
      for (int k = 0; k <= 1000; ++k)
        samples.push_back(position(curve, std::lerp(curve.domain().from, curve.domain().to, 0.001 * k)));
    for (int k = 0; k < 40; ++k) {
      const Vec3 near = samples[random() % samples.size()];
      const Vec3 point = near + rays::power(random, 1e-9, 2) * uniform_vector(random, -1, 1);
      const NearestCurvePoint found = scene.nearest(point);
      ASSERT_EQ(found.kind, NearestKind::found);
      EXPECT_TRUE(found.flags.certified);
      EXPECT_LE(length(position(curves[found.curve], found.t) - found.position), 1e-13);
      EXPECT_NEAR(length(found.position - point), found.distance, 1e-13);
      for (const Vec3& sample : samples) ASSERT_LE(found.distance, length(sample - point) + 1e-13);
      if (found.flags.border || found.distance < 1e-6) continue;
      const CurveJet jet = evaluate_jet(curves[found.curve], found.t);
      EXPECT_LE(std::abs(dot(normalized(found.position - point), jet.first)), 1e-7 * (1 + length(jet.second)));
    }
  }
}

TEST(NearestCurves, WrongInputAndLimits) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  EXPECT_EQ(CurveScene::make({}).status().code(), StatusCode::invalid_argument);
  const std::vector<Curve> point{value_of(Curve::bezier(std::vector<Vec3>{{1, 1, 1}, {1, 1, 1}}))};
  EXPECT_EQ(CurveScene::make(point).status().code(), StatusCode::unsupported);
  const std::vector<Curve> curves{circle()};
  const CurveScene scene = value_of(CurveScene::make(curves));
  EXPECT_EQ(scene.nearest({nan, 0, 0}).kind, NearestKind::invalid_point);
  EXPECT_EQ(scene.nearest({0, inf, 0}).kind, NearestKind::invalid_point);
  EXPECT_EQ(scene.nearest({3, 0, 0}, 1.9).kind, NearestKind::none);
  EXPECT_EQ(scene.nearest({3, 0, 0}, 2.1).kind, NearestKind::found);
  EXPECT_NEAR(scene.nearest({1e12, 0, 0}).distance, 1e12 - 1, 1e-3);
  std::vector<Vec3> points(3);
  std::vector<NearestCurvePoint> found(3);
  EXPECT_EQ(scene.nearest(points, std::span(found).first(2)).code(), StatusCode::buffer_too_small);
  EXPECT_EQ(scene.nearest(points, found, nan).code(), StatusCode::invalid_argument);
  EXPECT_TRUE(scene.nearest(std::span<const Vec3>(), std::span<NearestCurvePoint>()).ok());
  const std::atomic<bool> cancel = true;
  EXPECT_EQ(CurveScene::make(curves, {.cancel = &cancel}).status().code(), StatusCode::cancelled);
}

}}  // namespace tessera::test
