// Valid Bezier patches, and errors.

#include "tessera/bezier_patch.h"

#include <limits>

#include "support/random_patches.h"

namespace tessera::test { namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

void expect_error(const Result<BezierPatch>& result, StatusCode code, std::ptrdiff_t index, const char* message) {
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.status().code(), code);
  EXPECT_EQ(result.status().index(), index);
  EXPECT_EQ(result.status().message(), message);
}

TEST(BezierPatch, EveryDegreeFrom1To15) {
  Random random(1);
  for (int m = 1; m <= max_degree; ++m)
    for (int n = 1; n <= max_degree; ++n) {
      const BezierPatch patch = random_rational(random, m, n);
      EXPECT_EQ(patch.degree_u(), m);
      EXPECT_EQ(patch.degree_v(), n);
      EXPECT_EQ(patch.points().size(), static_cast<std::size_t>((m + 1) * (n + 1)));
      EXPECT_EQ(&patch.point(1, 1), &patch.points()[static_cast<std::size_t>(n + 2)]);
      EXPECT_EQ(patch.weight(m, n), patch.weights().back());
    }
}

TEST(BezierPatch, RefusesDegrees) {
  const std::vector<Vec3> points(17 * 2);
  expect_error(BezierPatch::polynomial(0, 3, points), StatusCode::unsupported_degree, -1,
               "degree u is 0, it must be 1 to 15");
  expect_error(BezierPatch::polynomial(1, 16, points), StatusCode::unsupported_degree, -1,
               "degree v is 16, it must be 1 to 15");
  expect_error(BezierPatch::polynomial(std::numeric_limits<int>::max(), 1, points), StatusCode::unsupported_degree, -1,
               "degree u is 2147483647, it must be 1 to 15");
  expect_error(BezierPatch::rational(1, -3, points, {}), StatusCode::unsupported_degree, -1,
               "degree v is -3, it must be 1 to 15");
}

TEST(BezierPatch, RefusesCounts) {
  expect_error(BezierPatch::polynomial(2, 3, std::vector<Vec3>(11)), StatusCode::count_mismatch, -1,
               "a patch of degree (2, 3) has 3 x 4 control points, found 11");
  expect_error(BezierPatch::polynomial(2, 3, {}), StatusCode::count_mismatch, -1,
               "a patch of degree (2, 3) has 3 x 4 control points, found 0");
  expect_error(BezierPatch::rational(1, 1, std::vector<Vec3>(4), std::vector<double>(5, 1)), StatusCode::count_mismatch,
               -1, "a patch of degree (1, 1) has 2 x 2 weights, found 5");
}

TEST(BezierPatch, RefusesPointsThatAreNotFinite) {
  for (const double bad : {nan, infinity, -infinity})
    for (std::size_t k = 0; k < 6; ++k)
      for (double Vec3::*component : {&Vec3::x, &Vec3::y, &Vec3::z}) {
        std::vector<Vec3> points(6);
        points[k].*component = bad;
        EXPECT_EQ(BezierPatch::polynomial(1, 2, points).status().code(), StatusCode::non_finite);
        EXPECT_EQ(BezierPatch::polynomial(1, 2, points).status().index(), static_cast<std::ptrdiff_t>(k));
        EXPECT_EQ(BezierPatch::rational(1, 2, points, std::vector<double>(6, 1)).status().code(),
                  StatusCode::non_finite);
      }
  expect_error(BezierPatch::polynomial(1, 2, std::vector<Vec3>{{}, {}, {}, {}, {0.5, infinity, 1e300}, {}}),
               StatusCode::non_finite, 4, "control point [1][1] is (0.5, inf, 1e+300), its coordinates must be finite");
}

TEST(BezierPatch, RefusesWeights) {
  const std::vector<Vec3> points(4);
  const auto with = [&](double weight) {
    return BezierPatch::rational(1, 1, points, std::vector<double>{1, 1, weight, 1});
  };
  expect_error(with(0), StatusCode::invalid_weight, 2, "weight [1][0] is 0, it must be finite and greater than 0");
  expect_error(with(-0.5), StatusCode::invalid_weight, 2,
               "weight [1][0] is -0.5, it must be finite and greater than 0");
  expect_error(with(infinity), StatusCode::invalid_weight, 2,
               "weight [1][0] is inf, it must be finite and greater than 0");
  expect_error(with(nan), StatusCode::invalid_weight, 2, "weight [1][0] is nan, it must be finite and greater than 0");
  expect_error(with(1e-101), StatusCode::invalid_weight, 2,
               "weight [1][0] is 1e-101, it must be at least 1e-100 of the largest weight, 1");
  EXPECT_TRUE(with(1e-99).ok());
  EXPECT_TRUE(with(1e99).ok());
}

TEST(BezierPatch, EqualWeightsAreDropped) {
  Random random(2);
  const std::vector<Vec3> points = random_points(random, 2, 2);
  for (const double weight : {1.0, 0.1, 5e-324, 1e308}) {
    const BezierPatch patch = rational(2, 2, points, std::vector<double>(9, weight));
    EXPECT_FALSE(patch.is_rational());
    EXPECT_TRUE(patch.weights().empty());
    EXPECT_EQ(patch.weight(1, 1), 1);
    EXPECT_TRUE(std::equal(points.begin(), points.end(), patch.points().begin()));
  }
  std::vector<double> weights(9, 0.1);
  weights[5] = std::nextafter(0.1, 1);
  EXPECT_TRUE(rational(2, 2, points, weights).is_rational());
}

TEST(BezierPatch, HullBox) {
  const BezierPatch patch = polynomial(1, 1, {{0, 5, -1}, {2, 0, 0}, {-3, 1, 4}, {1, 1, 1}});
  EXPECT_EQ(patch.hull_box().lower, (Vec3{-3, 0, -1}));
  EXPECT_EQ(patch.hull_box().upper, (Vec3{2, 5, 4}));
}

TEST(BezierPatch, CollapsedSides) {
  Random random(3);
  for (int sides = 0; sides < 16; ++sides) {
    std::vector<Vec3> points = random_points(random, 3, 2);
    for (int i = 0; i <= 3; ++i)
      for (int j = 0; j <= 2; ++j) {
        const bool collapsed =
            ((sides & 1) && j == 0) || ((sides & 2) && i == 3) || ((sides & 4) && j == 2) || ((sides & 8) && i == 0);
        if (collapsed) points[static_cast<std::size_t>(3 * i + j)] = {-0.0, 1, 2};
      }
    points[0] = points[0] == Vec3{0, 1, 2} ? Vec3{0, 1, 2} : points[0];  // by ==: 0 and -0 are one
    const SideMask mask = polynomial(3, 2, points).collapsed_sides();
    EXPECT_EQ(int{mask.bits}, sides);
    EXPECT_EQ(mask.any(), sides != 0);
  }
}

}}  // namespace tessera::test
