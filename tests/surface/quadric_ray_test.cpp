// Rays and quadrics in closed form: every hit satisfies the equation, every root is found, tangency is seen.

#include <limits>

#include "support/quadrics.h"
#include "support/ulp.h"

namespace tessera::test { namespace {

constexpr double quadric_ray_nan = std::numeric_limits<double>::quiet_NaN();
constexpr double quadric_ray_infinity = std::numeric_limits<double>::infinity();

TEST(QuadricRay, GoesThroughWhatItWasAimedAt) {
  Random random(1);
  for (const QuadricSample& sample : quadric_samples())
    for (int sheet = 0; sheet < sheet_count(sample.kind); ++sheet)
      for (int k = 0; k < 200; ++k) {
        const QuadricPiece part =
            piece(quadric(moved(sample.coefficients, random_frame(random, 2))), sample_range(sample.kind), sheet);
        const Domain& r = part.range();
        const Vec3 target = evaluate_jet(part, uniform(random, r.u0, r.u1), uniform(random, r.v0, r.v1)).position;
        const Vec3 direction = std::exp(uniform(random, -9, 9)) * normalized(uniform_vector(random, -1, 1));
        const double t = uniform(random, -20, 20) / length(direction);
        const QuadricHits hits = intersect(part, target - t * direction, direction);
        if (hits.contained) continue;
        double nearest = quadric_ray_infinity;
        for (int h = 0; h < hits.count; ++h)
          nearest = std::min(nearest, std::abs(hits.t[static_cast<std::size_t>(h)] - t) * length(direction));
        // Near tangency a root has half the digits.
        EXPECT_LT(nearest, 1e-5) << name(sample.kind) << " " << k;
        if (hits.count == 2) {
          EXPECT_LT(hits.t[0], hits.t[1]);
        }
      }
}

TEST(QuadricRay, UnitSphere) {
  const Quadric sphere = quadric({.a = 1, .b = 1, .c = 1, .k = -1});
  QuadricHits hits = intersect(sphere, {-3, 0, 0}, {1, 0, 0});
  ASSERT_EQ(hits.count, 2);
  EXPECT_EQ(hits.t[0], 2);
  EXPECT_EQ(hits.t[1], 4);
  hits = intersect(sphere, {-3, 0, 0}, {-0.5, 0, 0});
  ASSERT_EQ(hits.count, 2);
  EXPECT_EQ(hits.t[0], -8);
  EXPECT_EQ(hits.t[1], -4);
  hits = intersect(sphere, {-3, 1, 0}, {1, 0, 0});
  EXPECT_EQ(hits.count, 1);
  EXPECT_TRUE(hits.tangent);
  EXPECT_EQ(hits.t[0], 3);
  EXPECT_EQ(intersect(sphere, {-3, 1.0000001, 0}, {1, 0, 0}).count, 0);
  EXPECT_EQ(intersect(sphere, {-3, 0.9999999, 0}, {1, 0, 0}).count, 2);
}

TEST(QuadricRay, FarOriginsLoseOnlyTheirOwnRounding) {
  Random random(2);
  const Quadric sphere = quadric({.a = 1, .b = 1, .c = 1, .k = -1});
  for (int k = 0; k < 1000; ++k) {
    const Vec3 out = normalized(uniform_vector(random, -1, 1));
    const double distance = std::exp(uniform(random, 0, 20));
    const QuadricHits hits = intersect(sphere, distance * out, -out);
    ASSERT_EQ(hits.count, 2);
    EXPECT_NEAR(hits.t[0], distance - 1, 8 * double_unit * distance);
    EXPECT_NEAR(hits.t[1], distance + 1, 8 * double_unit * distance);
  }
}

TEST(QuadricRay, LinesOnTheSurfaceAreContained) {
  const Quadric ruled = quadric({.a = 1, .b = 1, .c = -1, .k = -1});
  EXPECT_TRUE(intersect(ruled, {1, 0, 0}, {0, 1, 1}).contained);
  EXPECT_TRUE(intersect(ruled, {1, 0, 0}, {0, 1, -1}).contained);
  EXPECT_FALSE(intersect(ruled, {1.001, 0, 0}, {0, 1, 1}).contained);
  const Quadric saddle = quadric({.a = 1, .b = -1, .j = -0.5});
  EXPECT_TRUE(intersect(saddle, {}, {1, 1, 0}).contained);
  // Parallel to the asymptotic plane: one root.
  const QuadricHits one = intersect(saddle, {1, 0, 0}, {1, 1, 0});
  EXPECT_EQ(one.count, 1);
  EXPECT_FALSE(one.tangent);
  EXPECT_EQ(one.t[0], -0.5);
  EXPECT_EQ(intersect(quadric({.a = 1, .j = -0.5}), {1, 0, 0}, {0, 0, 1}).count, 1);
}

TEST(QuadricRay, EmptyQuadricsAreMissed) {
  Random random(3);
  for (const QuadricSample& sample : quadric_samples())
    if (sample.kind >= QuadricKind::imaginary_ellipsoid)
      for (int k = 0; k < 100; ++k) {
        const QuadricHits hits =
            intersect(quadric(sample.coefficients), uniform_vector(random, -3, 3), uniform_vector(random, -1, 1));
        EXPECT_EQ(hits.count, 0) << name(sample.kind);
        EXPECT_FALSE(hits.contained);
      }
}

TEST(QuadricRay, PiecesAreHitWithinTheirRanges) {
  const Quadric sphere = quadric({.a = 1, .b = 1, .c = 1, .k = -1});
  const QuadricPiece north = piece(sphere, {0, 6.28318530717958647, 0.1, 1.57079632679489662});
  const QuadricHits hits = intersect(north, {0.1, 0.2, 5}, {0, 0, -1});
  ASSERT_EQ(hits.count, 1);
  EXPECT_NEAR(hits.t[0], 5 - std::sqrt(0.95), 1e-15);
  EXPECT_EQ(intersect(north, {5, 0, 0}, {-1, 0, 0}).count, 0);
  const Quadric two = quadric({.a = -1, .b = -1, .c = 1, .k = -1});
  for (const int sheet : {0, 1}) {
    const QuadricHits one = intersect(piece(two, {0, 6.28, 0, 2}, sheet), {0.1, 0.1, 5}, {0, 0, -1});
    ASSERT_EQ(one.count, 1);
    EXPECT_NEAR(one.t[0], 5 + (sheet ? 1 : -1) * std::sqrt(1.02), 1e-14);
  }
}

TEST(QuadricRay, BadRaysHitNothing) {
  const Quadric sphere = quadric({.a = 1, .b = 1, .c = 1, .k = -1});
  for (const double bad : {quadric_ray_nan, quadric_ray_infinity})
    for (const auto component : {&Vec3::x, &Vec3::y, &Vec3::z}) {
      Vec3 origin{-3, 0, 0}, direction{1, 0, 0};
      origin.*component = bad;
      EXPECT_EQ(intersect(sphere, origin, direction).count, 0);
      origin.*component = 0;
      direction.*component = bad;
      EXPECT_EQ(intersect(sphere, origin, direction).count, 0);
    }
  EXPECT_EQ(intersect(sphere, {}, {}).count, 0);
  EXPECT_EQ(intersect(sphere, {}, {1e-310, 0, 0}).count, 0);  // t overflows
  EXPECT_EQ(intersect(sphere, {}, {1e300, 0, 0}).count, 2);
}

}}  // namespace tessera::test
