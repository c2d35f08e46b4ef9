#include "trim/plane_bezier.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "trim/quad_winding.h"

namespace tessera { namespace {

using test::Quad;
using test::QuadBezier;

PlaneBezier random_bezier(std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  PlaneBezier curve;
  const std::size_t count = 2 + random() % max_degree;
  for (std::size_t i = 0; i < count; ++i) curve.points.push_back({10 + uniform(random), uniform(random)});
  if (random() % 2 == 0)
    for (std::size_t i = 0; i < count; ++i) curve.weights.push_back(std::exp(2 * uniform(random)));
  return curve;
}

QuadBezier plane_bezier_in_quad(const PlaneBezier& curve) {
  QuadBezier quad;
  for (std::size_t i = 0; i < curve.points.size(); ++i) {
    const Quad w = curve.weight(i);
    quad.points.push_back({w * curve.points[i].u, w * curve.points[i].v, w});
  }
  return quad;
}

double plane_bezier_error(Quad a, Quad b) { return static_cast<double>(a > b ? a - b : b - a); }

TEST(PlaneBezier, PrecisePointsAgreeWithQuadrupleNumbers) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int k = 0; k < 2000; ++k) {
    const PlaneBezier curve = random_bezier(random);
    const double t = k % 10 == 0 ? k % 20 / 10 : uniform(random);
    const PrecisePoint p = precise_point(curve, t);
    const auto expected = plane_bezier_in_quad(curve).at(t);
    ASSERT_LE(plane_bezier_error(Quad(p.u.high) + Quad(p.u.low), expected.u), 1e-29);
    ASSERT_LE(plane_bezier_error(Quad(p.v.high) + Quad(p.v.low), expected.v), 1e-29);
  }
}

TEST(PlaneBezier, RelativePointsKeepTheirBound) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> uniform(0, 1);
  double worst = 0;
  for (int k = 0; k < 20000; ++k) {
    const PlaneBezier curve = random_bezier(random);
    const double t = uniform(random);
    const ParameterPoint q = k % 2 == 0 ? precise_point(curve, t).rounded() : ParameterPoint{10, 0};
    const auto expected = plane_bezier_in_quad(curve).at(t);
    const ParameterPoint p = relative_point(curve, q, t);
    ParameterPoint farthest;
    for (const ParameterPoint& point : curve.points) farthest = larger(farthest, distance(point, q));
    const double bound = plane_error(curve.degree());
    worst = std::max(worst, plane_bezier_error(p.u, expected.u - q.u) / (bound * farthest.u));
    worst = std::max(worst, plane_bezier_error(p.v, expected.v - q.v) / (bound * farthest.v));
  }
  EXPECT_LE(worst, 1);
  EXPECT_GE(worst, 0.02) << "the bound is far from what happens";
}

TEST(PlaneBezier, PartsAreTheSameCurve) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int k = 0; k < 1000; ++k) {
    const PlaneBezier curve = random_bezier(random);
    double t0 = k % 7 == 0 ? 0 : uniform(random), t1 = k % 5 == 0 ? 1 : uniform(random);
    if (k % 3 == 0) t1 = std::min(1.0, t0 + 1e-9);
    if (t0 > t1) std::swap(t0, t1);
    const PlaneBezier part = tessera::part(curve, t0, t1);
    const QuadBezier whole = plane_bezier_in_quad(curve), expected = plane_bezier_in_quad(part);
    for (const double s : {0.0, 0.1, 0.5, 0.77, 1.0}) {
      const auto a = expected.at(s), b = whole.at(t0 + Quad(s) * (Quad(t1) - t0));
      ASSERT_LE(plane_bezier_error(a.u, b.u), 12 * 0x1p-52);  // one rounding of coordinates up to 11
      ASSERT_LE(plane_bezier_error(a.v, b.v), 12 * 0x1p-52);  // and of weights
    }
  }
}

TEST(PlaneBezier, CurvesAreMonotoneBetweenTheirExtrema) {
  std::mt19937 random(4);
  std::size_t found = 0;
  for (int k = 0; k < 500; ++k) {
    const PlaneBezier curve = random_bezier(random);
    for (const int along : {0, 1}) {
      std::vector<double> cuts{0};
      append_extrema(curve, along, cuts);
      found += cuts.size() - 1;
      cuts.push_back(1);
      for (std::size_t c = 0; c + 1 < cuts.size(); ++c) {
        ASSERT_LT(cuts[c], cuts[c + 1]);
        const auto value = [&](double s) {
          const ParameterPoint p = precise_point(curve, cuts[c] + s * (cuts[c + 1] - cuts[c])).rounded();
          return along == 0 ? p.u : p.v;
        };
        const double sign = value(1) > value(0) ? 1 : -1;
        for (int i = 0; i < 40; ++i) ASSERT_GE(sign * (value((i + 1) / 40.0) - value(i / 40.0)), -1e-13);
      }
    }
  }
  EXPECT_GT(found, 500u);
}

TEST(PlaneBezier, ExtremaThatCoincide) {
  std::vector<double> cuts;
  append_extrema({{{0, 0}, {1, 0}, {2, 0}, {3, 1}}, {}}, 1, cuts);  // v = t^3
  EXPECT_TRUE(cuts.empty());
  append_extrema({{{0, 5}, {1, 5}, {2, 5}, {3, 5}}, {}}, 1, cuts);  // constant
  EXPECT_TRUE(cuts.empty());
  append_extrema({{{0, -1}, {1, 1}, {2, -1}, {3, 1}}, {}}, 1, cuts);  // v = (2 t - 1)^3: an inflection at rest
  ASSERT_LE(cuts.size(), 2u);
  for (const double t : cuts) EXPECT_NEAR(t, 0.5, 1e-7);
  cuts.clear();
  append_extrema({{{0, 0}, {1, 1}, {2, 0}}, {}}, 1, cuts);
  EXPECT_EQ(cuts, std::vector<double>{0.5});
}

}}  // namespace tessera
