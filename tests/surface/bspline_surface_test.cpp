#include "tessera/nurbs_surface.h"

#include <cmath>
#include <limits>

#include "support/errors.h"
#include "support/lecture_points.h"
#include "support/random_splines.h"
#include "support/ulp.h"

namespace tessera::test { namespace {

const std::vector<KnotStyle> styles{{0}, {2}, {3, true, true}, {2, false, false}, {2, false, true}};

TEST(BSplineSurface, EqualsTheDefinition) {
  Random random(1);
  for (const auto& [p, q] : {std::pair{1, 1}, {2, 2}, {3, 3}, {1, 5}, {4, 2}, {7, 6}})
    for (std::size_t k = 0; k < styles.size(); ++k)
      for (const bool rational : {false, true}) {
        const BSplineSurface s = random_surface(random, p, q, styles[k], styles[(k + 2) % styles.size()], rational);
        for (const double u : sample_parameters(random, s.knots_u(), s.domain().u0, s.domain().u1, 1))
          for (const double v : sample_parameters(random, s.knots_v(), s.domain().v0, s.domain().v1, 1)) {
            const SurfaceJet jet = evaluate_jet(s, u, v);
            const RealJet expected = reference_jet(s, u, v);
            EXPECT_TRUE(within_units(jet.position, expected.position.rounded(), double_unit, 8))
                << p << q << " " << u << " " << v;
            const double slope = 1 + std::max(max_abs(expected.du.rounded()), max_abs(expected.dv.rounded()));
            EXPECT_TRUE(within_units(jet.du, expected.du.rounded(), double_unit * slope, 400));
            EXPECT_TRUE(within_units(jet.dv, expected.dv.rounded(), double_unit * slope, 400));
            const double bend =
                slope * slope + std::max({max_abs(expected.duu.rounded()), max_abs(expected.duv.rounded()),
                                          max_abs(expected.dvv.rounded())});
            EXPECT_TRUE(within_units(jet.duu, expected.duu.rounded(), double_unit * bend, 4000));
            EXPECT_TRUE(within_units(jet.duv, expected.duv.rounded(), double_unit * bend, 4000));
            EXPECT_TRUE(within_units(jet.dvv, expected.dvv.rounded(), double_unit * bend, 4000));
          }
      }
}

TEST(BSplineSurface, OnBezierKnotsItIsTheBezierPatch) {
  Random random(2);
  for (const auto& [p, q] : {std::pair{1, 2}, {3, 3}, {15, 14}}) {
    const BSplineSurface s = random_surface(random, p, q, {0}, {0}, true);
    const BezierPatch patch = value_of(BezierPatch::rational(p, q, s.points(), s.weights()));
    for (int k = 0; k < 20; ++k) {
      const double a = uniform(random, 0, 1), b = uniform(random, 0, 1);
      EXPECT_TRUE(within_units(evaluate_jet(s, s.domain().u_at(a), s.domain().v_at(b)).position,
                               reference_position(patch, a, b), double_unit, 16));
    }
  }
}

TEST(Figures, UniformBSpline) {
  const std::vector<double> knots{-3, -2, -1, 0, 1, 2, 3, 4};
  const BSplineSurface s = value_of(BSplineSurface::polynomial(3, knots, 3, knots, lecture_points()));
  EXPECT_EQ(s.domain(), Domain{});
  EXPECT_TRUE(within_units(evaluate_jet(s, 0.3, 0.6).position,
                           {3184649 / 4500000.0, 296411 / 375000.0, 149747 / 4500000.0}, double_unit, 4));
  EXPECT_TRUE(within_units(evaluate_jet(s, 0, 0).position, {7 / 9.0, 5 / 6.0, -7 / 18.0}, double_unit, 2));
  // The border curve s(u,0) has the polygon (V_i0 + 4 V_i1 + V_i2) / 6.
  std::vector<Vec3> polygon;
  for (std::size_t i = 0; i < 4; ++i)
    polygon.push_back((1 / 6.0) * (s.point(i, 0) + 4 * s.point(i, 1) + s.point(i, 2)));
  const Curve border = value_of(Curve::b_spline(3, polygon, knots));
  for (int k = 0; k <= 10; ++k)
    EXPECT_TRUE(
        within_units(evaluate_jet(s, k / 10.0, 0).position, evaluate_jet(border, k / 10.0).position, double_unit, 4));
}

TEST(BSplineSurface, UnitWeightsGiveTheSameBits) {
  Random random(3);
  for (const double weight : {1.0, 0.1, 3e7}) {
    const BSplineSurface plain = random_surface(random, 3, 3, {1}, {1}, false);
    const std::vector<double> weights(plain.points().size(), weight);
    const BSplineSurface weighted =
        value_of(BSplineSurface::rational(3, plain.knots_u(), 3, plain.knots_v(), plain.points(), weights));
    EXPECT_FALSE(weighted.is_rational());
    for (int k = 0; k < 20; ++k) {
      const double u = plain.domain().u_at(uniform(random, 0, 1)), v = plain.domain().v_at(uniform(random, 0, 1));
      EXPECT_EQ(evaluate_jet(plain, u, v).position, evaluate_jet(weighted, u, v).position);
      EXPECT_EQ(evaluate_jet(plain, u, v).duv, evaluate_jet(weighted, u, v).duv);
    }
  }
}

TEST(BSplineSurface, PeriodicOnesClose) {
  // Six rows of control points, the first three repeated; uniform knots: a C2 tube.
  Random random(4);
  std::vector<double> around, along{0, 0, 1, 1};
  for (int k = 0; k < 13; ++k) around.push_back(k);
  std::vector<Vec3> points = random_cloud(random, 12);
  points.insert(points.end(), points.begin(), points.begin() + 6);
  const BSplineSurface s = value_of(BSplineSurface::polynomial(3, around, 1, along, points));
  EXPECT_EQ(s.domain(), (Domain{3, 9, 0, 1}));
  for (const double v : {0.0, 0.3, 1.0}) {
    const SurfaceJet first = evaluate_jet(s, 3, v), last = evaluate_jet(s, 9, v);
    EXPECT_TRUE(within_units(first.position, last.position, double_unit, 4));
    EXPECT_TRUE(within_units(first.du, last.du, double_unit, 8));
    EXPECT_TRUE(within_units(first.duu, last.duu, double_unit, 16));
  }
}

TEST(BSplineSurface, AtKnotsOfFullMultiplicityTheRightCounts) {
  // A roof: flat up to u = 1, then down.
  const std::vector<double> u{0, 0, 1, 2, 2}, v{0, 0, 1, 1};
  const std::vector<Vec3> points{{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}, {2, 0, -1}, {2, 1, -1}};
  const BSplineSurface roof = value_of(BSplineSurface::polynomial(1, u, 1, v, points));
  EXPECT_EQ(evaluate_jet(roof, std::nextafter(1, 0), 0.5).du, (Vec3{1, 0, 0}));
  EXPECT_EQ(evaluate_jet(roof, 1, 0.5).du, (Vec3{1, 0, -1}));
  EXPECT_EQ(evaluate_jet(roof, 2, 1).du, (Vec3{1, 0, -1}));
  const BSplineSurface half = value_of(BSplineSurface::polynomial(1, u, 1, v, points, Domain{0.25, 1, 0, 1}));
  EXPECT_EQ(evaluate_jet(half, 1, 0.5).du, (Vec3{1, 0, 0}));  // the end of this domain: from the left
}

TEST(BSplineSurface, ScaleDoesNotMatter) {
  Random random(5);
  const BSplineSurface s = random_surface(random, 3, 2, {2}, {1}, true);
  for (const double scale : {0x1p-900, 0x1p900}) {
    std::vector<Vec3> points(s.points().begin(), s.points().end());
    for (Vec3& p : points) p = scale * p;
    std::vector<double> weights(s.weights().begin(), s.weights().end());
    for (double& w : weights) w *= 1 / scale;
    const BSplineSurface far = value_of(BSplineSurface::rational(3, s.knots_u(), 2, s.knots_v(), points, weights));
    const double u = s.domain().u_at(0.3), v = s.domain().v_at(0.8);
    EXPECT_EQ(evaluate_jet(far, u, v).position, scale * evaluate_jet(s, u, v).position);
    EXPECT_EQ(evaluate_jet(far, u, v).duv, scale * evaluate_jet(s, u, v).duv);
  }
}

TEST(BSplineSurface, BadInputIsNamed) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<double> u{0, 0, 0, 1, 1, 1}, v{0, 0, 1, 1};
  const std::vector<Vec3> points(6, Vec3{1, 2, 3});
  const auto make = [&](int p, const std::vector<double>& ku, int q, const std::vector<double>& kv,
                        const std::vector<Vec3>& net) {
    return BSplineSurface::polynomial(p, ku, q, kv, net).status();
  };
  EXPECT_TRUE(make(2, u, 1, v, points).ok());
  EXPECT_EQ(make(0, u, 1, v, points).code(), StatusCode::unsupported_degree);
  EXPECT_NE(make(2, u, 16, v, points).message().find("degree v"), std::string::npos);
  EXPECT_EQ(make(2, u, 1, {0, 0, 1}, points).code(), StatusCode::count_mismatch);
  EXPECT_NE(make(2, u, 1, {0, 2, 1, 3}, points).message().find("knots v[2]"), std::string::npos);
  EXPECT_EQ(make(2, {0, 0, 0, 0, 1, 1, 1}, 1, v, std::vector<Vec3>(8)).code(), StatusCode::invalid_argument);
  EXPECT_EQ(make(2, u, 1, v, std::vector<Vec3>(5)).code(), StatusCode::count_mismatch);
  EXPECT_NE(make(2, u, 1, v, std::vector<Vec3>(5)).message().find("3 x 2 control points, found 5"), std::string::npos);
  std::vector<Vec3> hole = points;
  hole[3].z = nan;
  EXPECT_EQ(make(2, u, 1, v, hole).code(), StatusCode::non_finite);
  EXPECT_EQ(make(2, u, 1, v, hole).index(), 3);
  EXPECT_NE(make(2, u, 1, v, hole).message().find("[1][1]"), std::string::npos);
  for (const double bad : {0.0, -0.5, nan, std::numeric_limits<double>::infinity()}) {
    const Status status =
        BSplineSurface::rational(2, u, 1, v, points, std::vector<double>{1, 1, 1, 1, bad, 1}).status();
    EXPECT_EQ(status.code(), StatusCode::invalid_weight);
    EXPECT_NE(status.message().find("weight [2][0]"), std::string::npos) << status.message();
  }
  // Even if the denominator, 1 - 2 u (1 - u) here, is positive everywhere.
  expect_refused(BSplineSurface::rational(2, u, 1, v, points, std::vector<double>{1, 1, 0, 0, 1, 1}),
                 StatusCode::invalid_weight, 2, "weight [1][0] is 0, it must be finite and greater than 0");
  EXPECT_EQ(BSplineSurface::rational(2, u, 1, v, points, std::vector<double>(7, 1)).status().code(),
            StatusCode::count_mismatch);
  EXPECT_EQ(BSplineSurface::polynomial(2, u, 1, v, points, Domain{0, 1, 0.5, 1.5}).status().code(),
            StatusCode::invalid_argument);
}

}}  // namespace tessera::test
