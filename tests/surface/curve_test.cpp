#include "tessera/curve.h"

#include <cmath>
#include <limits>

#include "support/errors.h"
#include "support/random_splines.h"
#include "support/ulp.h"
#include "tessera/nurbs_surface.h"

namespace tessera::test { namespace {

TEST(Curve, EqualsTheDefinition) {
  Random random(1);
  for (int degree = 1; degree <= 8; ++degree)
    for (const KnotStyle& style : {KnotStyle{0}, KnotStyle{4}, KnotStyle{4, true, true}, KnotStyle{3, false, true}})
      for (const bool rational : {false, true}) {
        const Curve curve = random_curve(random, degree, style, rational);
        for (const double t : sample_parameters(random, curve.knots(), curve.domain().from, curve.domain().to, 5)) {
          const CurveJet jet = evaluate_jet(curve, t);
          EXPECT_EQ(position(curve, t), jet.position);
          const RealJet expected = reference_jet(curve, t);
          EXPECT_TRUE(within_units(jet.position, expected.position.rounded(), double_unit, 8)) << degree << " " << t;
          const double slope = 1 + max_abs(expected.du.rounded()),
                       bend = slope * slope + max_abs(expected.duu.rounded());
          EXPECT_TRUE(within_units(jet.first, expected.du.rounded(), double_unit * slope, 400)) << degree << " " << t;
          EXPECT_TRUE(within_units(jet.second, expected.duu.rounded(), double_unit * bend, 4000)) << degree << " " << t;
        }
      }
}

TEST(Curve, BezierInterpolatesItsEndsOnItsDomain) {
  const std::vector<Vec3> points{{1, 2, 3}, {0.1, 7, 1}, {5, 4, 0.3}};
  for (const std::vector<double>& weights : {std::vector<double>{}, std::vector<double>{1, 0.3, 2}}) {
    const Curve curve = value_of(Curve::bezier(points, weights, {-2, 5}));
    EXPECT_EQ(curve.domain(), (Interval{-2, 5}));
    EXPECT_EQ(evaluate_jet(curve, -2).position, points.front());
    EXPECT_EQ(evaluate_jet(curve, 5).position, points.back());
  }
}

TEST(Curve, AtAKnotOfFullMultiplicityTheRightCountsAtTheEndTheLeft) {
  // Two straight legs of speed 1 and 2.
  const std::vector<double> knots{0, 0, 1, 2, 2};
  const std::vector<Vec3> points{{0, 0, 0}, {1, 0, 0}, {1, 2, 0}};
  const Curve whole = value_of(Curve::b_spline(1, points, knots));
  EXPECT_EQ(evaluate_jet(whole, 1).first, (Vec3{0, 2, 0}));
  EXPECT_EQ(evaluate_jet(whole, 1).position, points[1]);
  const Curve part = value_of(Curve::b_spline(1, points, knots, Interval{0, 1}));
  EXPECT_EQ(evaluate_jet(part, 1).first, (Vec3{1, 0, 0}));
  EXPECT_EQ(evaluate_jet(part, 1).position, points[1]);
}

TEST(Curve, CirclesAreRound) {
  for (const CircleArcs arcs : {CircleArcs::three, CircleArcs::four})
    for (const double radius : {1.0, 0.37, 1234.5}) {
      const Curve curve = value_of(make_nurbs_circle({}, radius, arcs));
      for (int k = 0; k <= 3000; ++k)
        EXPECT_NEAR(length(evaluate_jet(curve, k / 3000.0).position), radius, 4 * 0x1p-52 * radius) << k;
      EXPECT_EQ(evaluate_jet(curve, 0).position, evaluate_jet(curve, 1).position);
    }
}

TEST(Curve, EqualWeightsAreDropped) {
  Random random(2);
  const Curve plain = random_curve(random, 3, {4}, false);
  const std::vector<double> weights(plain.points().size(), 0.3);
  const Curve weighted = value_of(Curve::nurbs(3, plain.points(), weights, plain.knots()));
  EXPECT_FALSE(weighted.is_rational());
}

TEST(Curve, BadInputIsNamed) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<Vec3> points{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}};
  const std::vector<double> knots{0, 0, 0, 1, 1, 1}, weights{1, 2, 1};
  const auto code = [](const Result<Curve>& result) { return result.status().code(); };
  EXPECT_EQ(code(Curve::b_spline(0, points, knots)), StatusCode::unsupported_degree);
  EXPECT_EQ(code(Curve::b_spline(16, points, knots)), StatusCode::unsupported_degree);
  EXPECT_EQ(code(Curve::bezier({})), StatusCode::unsupported_degree);
  EXPECT_EQ(code(Curve::bezier(std::vector<Vec3>(17))), StatusCode::unsupported_degree);
  EXPECT_EQ(code(Curve::b_spline(1, points, knots)), StatusCode::count_mismatch);
  EXPECT_EQ(code(Curve::bezier(points, {}, {1, 1})), StatusCode::invalid_argument);
  EXPECT_EQ(code(Curve::b_spline(2, points, knots, Interval{0, 2})), StatusCode::invalid_argument);
  EXPECT_EQ(code(Curve::nurbs(2, points, std::vector<double>{1, 2}, knots)), StatusCode::count_mismatch);
  for (const double bad : {0.0, -1.0, nan, 1e-101}) {
    const Result<Curve> result = Curve::nurbs(2, points, std::vector<double>{1, bad, 1}, knots);
    expect_refused(result, StatusCode::invalid_weight, 1, "weight [1]");
  }
  // Even if the denominator is positive everywhere.
  expect_refused(Curve::bezier(points, std::vector<double>{1, 0, 1}), StatusCode::invalid_weight, 1,
                 "weight [1] is 0, it must be finite and greater than 0");
  const std::vector<Vec3> holes{{0, 0, 0}, {1, 0, 0}, {1, nan, 0}};
  EXPECT_EQ(code(Curve::b_spline(2, holes, knots)), StatusCode::non_finite);
  EXPECT_NE(Curve::b_spline(2, holes, knots).status().message().find("control point [2]"), std::string::npos);
}

}}  // namespace tessera::test
