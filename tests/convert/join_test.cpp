// Joins: the figures of section 12, bounds against dense samples, and joins that are made are measured as such.

#include "tessera/bezier_operations.h"

#include <limits>
#include <numbers>

#include "support/random_patches.h"
#include "support/synthetic_sets.h"

namespace tessera::test { namespace {

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();
constexpr Side edges[] = {Side::u0, Side::u1, Side::v0, Side::v1};

JoinReport measured(const JoinedPatch& p, const JoinedPatch& q, const JoinTolerances& tolerances = {}) {
  return value_of(measure_join(p, q, tolerances));
}

/// (u, v, (1-u)^2).
BezierPatch parabolic_cylinder() {
  return polynomial(2, 1, {{0, 0, 1}, {0, 1, 1}, {0.5, 0, 0}, {0.5, 1, 0}, {1, 0, 0}, {1, 1, 0}});
}
/// (1 + s u, v, 0).
BezierPatch plane(double s) { return polynomial(1, 1, {{1, 0, 0}, {1, 1, 0}, {1 + s, 0, 0}, {1 + s, 1, 0}}); }

TEST(Join, ParabolicCylinderWithPlanes) {
  const BezierPatch cylinder = parabolic_cylinder(), near = plane(1), far = plane(2);
  const JoinReport c1 = measured({cylinder, Side::u1}, {near, Side::u0});
  EXPECT_EQ(c1.continuity, Continuity::c1);
  EXPECT_EQ(c1.ratio, 1);
  EXPECT_EQ(c1.position_gap, 0);
  EXPECT_EQ(c1.normal_angle, 0);
  EXPECT_EQ(c1.derivative_gap, 0);
  const JoinReport g1 = measured({cylinder, Side::u1}, {far, Side::u0});
  EXPECT_EQ(g1.continuity, Continuity::g1);
  EXPECT_EQ(g1.ratio, 0.5);
  EXPECT_EQ(g1.derivative_gap, 1);
  // On a domain twice as wide the same patch is C1.
  EXPECT_EQ(measured({cylinder, Side::u1}, {far, Side::u0, {1, 3, 0, 1}}).continuity, Continuity::c1);
}

TEST(Join, AnyOrientationIsMeasuredTheSame) {
  const BezierPatch cylinder = parabolic_cylinder();
  for (int way = 0; way < 8; ++way)
    for (int other = 0; other < 8; ++other) {
      const BezierPatch p = reoriented(cylinder, way), q = reoriented(plane(2), other);
      int found = 0;
      for (const Side a : edges)
        for (const Side b : edges) {
          const JoinReport report = measured({p, a}, {q, b});
          if (report.continuity == Continuity::none) continue;
          ++found;
          EXPECT_EQ(report.continuity, Continuity::g1);
          EXPECT_EQ(report.ratio, 0.5);
        }
      EXPECT_EQ(found, 1);
    }
}

/// The largest angle and gaps at many samples along edge u1 of p and u0 of q.
struct Sampled {
  double gap = 0, angle = 0, derivative = 0;
};
Sampled sampled(const BezierPatch& p, const BezierPatch& q) {
  Sampled result;
  for (int k = 0; k <= 2000; ++k) {
    const double v = k / 2000.0;
    const SurfaceJet a = evaluate_jet(p, 1, v), b = evaluate_jet(q, 0, v);
    const Vec3 na = cross(a.du, a.dv), nb = cross(b.du, b.dv);
    result.gap = std::max(result.gap, length(a.position - b.position));
    result.angle = std::max(result.angle, std::atan2(length(cross(na, nb)), dot(na, nb)));
    result.derivative = std::max(result.derivative, length(a.du - b.du));
  }
  return result;
}

TEST(Join, BoundsHoldAndAreSharp) {
  Random random(1);
  for (int k = 0; k < 60; ++k) {
    const int m = 1 + k % 4, n = 1 + k % 5, l = 1 + k % 3;
    std::vector<Vec3> a, b;
    for (int i = 0; i <= m; ++i)
      for (int j = 0; j <= n; ++j)
        a.push_back(Vec3{i / double(m) - 1, j / double(n), 0} + 0.1 * uniform_vector(random, -1, 1));
    for (int i = 0; i <= m; ++i)
      for (int j = 0; j <= l; ++j)
        b.push_back(Vec3{i / double(m), j / double(l), 0} + 0.1 * uniform_vector(random, -1, 1));
    const bool weighted = k % 2;
    const BezierPatch p = weighted ? rational(m, n, a, random_weights(random, m, n, 0.7, 1.4)) : polynomial(m, n, a);
    const BezierPatch q = k % 4 == 1 ? rational(m, l, b, random_weights(random, m, l, 0.7, 1.4)) : polynomial(m, l, b);
    const JoinReport report = measured({p, Side::u1}, {q, Side::u0});
    const Sampled seen = sampled(p, q);
    EXPECT_TRUE(report.sharp);
    EXPECT_GE(report.position_gap, seen.gap * (1 - 1e-12));
    EXPECT_LE(report.position_gap, seen.gap * 1.0011 + 1e-12);
    EXPECT_GE(report.normal_angle, seen.angle * (1 - 1e-12));
    EXPECT_LE(report.normal_angle, seen.angle * 1.0011 + 1e-6);
    EXPECT_GE(report.derivative_gap, seen.derivative * (1 - 1e-12));
    EXPECT_LE(report.derivative_gap, seen.derivative * 1.0011 + 1e-6);
    EXPECT_EQ(report.continuity, Continuity::none);
  }
}

TEST(Join, AKinkBetweenSamplesIsSeen) {
  // The normals agree at v = 0, 1/2 and 1, and nowhere else.
  std::vector<Vec3> a, b;
  const double heights[] = {0, 1, -1, 0};
  for (int i = 0; i <= 1; ++i)
    for (int j = 0; j <= 3; ++j) {
      a.push_back({i - 1.0, j / 3.0, 0});
      b.push_back({double(i), j / 3.0, i * heights[j]});
    }
  const BezierPatch p = polynomial(1, 3, a), q = polynomial(1, 3, b);
  for (const double v : {0.0, 0.5, 1.0}) EXPECT_LT(length(cross(evaluate_jet(q, 0, v).du, Vec3{1, 0, 0})), 1e-15);
  const JoinReport report = measured({p, Side::u1}, {q, Side::u0});
  EXPECT_EQ(report.continuity, Continuity::c0);
  EXPECT_NEAR(report.normal_angle, std::atan(std::sqrt(3) / 6), 1e-3);
}

TEST(Join, FoldsAreNotSmooth) {
  // A patch that folds back over itself: the normals are opposite.
  const BezierPatch p = plane(1), q = polynomial(1, 1, {{2, 0, 0}, {2, 1, 0}, {1, 0, 0}, {1, 1, 0}});
  const JoinReport report = measured({p, Side::u1}, {q, Side::u0});
  EXPECT_EQ(report.continuity, Continuity::c0);
  EXPECT_NEAR(report.normal_angle, std::numbers::pi, 1e-12);
  EXPECT_FALSE(report.ratio.has_value());
  const double c = std::cos(2.5), s = std::sin(2.5);
  const BezierPatch bent = polynomial(1, 1, {{2, 0, 0}, {2, 1, 0}, {2 + c, 0, s}, {2 + c, 1, s}});
  EXPECT_NEAR(measured({p, Side::u1}, {bent, Side::u0}).normal_angle, 2.5, 1e-12);
}

TEST(Join, SphereOctantsJoinSmoothlyThroughThePole) {
  const double h = std::sqrt(0.5), w[] = {1, h, 1};
  std::vector<double> weights;
  for (const double a : w)
    for (const double b : w) weights.push_back(a * b);
  const auto octant = [&](Vec3 x, Vec3 y) {
    const Vec3 z{0, 0, 1};
    return rational(2, 2, {x, x + y, y, x + z, x + y + z, y + z, z, z, z}, weights);
  };
  const BezierPatch first = octant({1, 0, 0}, {0, 1, 0}), second = octant({0, 1, 0}, {-1, 0, 0});
  const JoinReport report = measured({first, Side::v1}, {second, Side::v0});
  EXPECT_EQ(report.continuity, Continuity::c1);
  EXPECT_LT(report.normal_angle, 1e-10);
  EXPECT_LT(report.derivative_gap, 1e-14);
  EXPECT_TRUE(report.sharp);
  ASSERT_TRUE(report.ratio.has_value());
  EXPECT_NEAR(*report.ratio, 1, 1e-14);
  // The collapsed sides themselves have no tangent along them.
  EXPECT_NE(measured({first, Side::u1}, {second, Side::u1}).continuity, Continuity::g1);
}

TEST(Join, WhatIsMadeIsMeasured) {
  Random random(2);
  for (int k = 0; k < 80; ++k) {
    const Side a = edges[k % 4], b = edges[(k / 4) % 4];
    const BezierPatch p = k % 3 == 1 ? random_rational(random, 1 + k % 3, 1 + k % 4, 0.8, 1.2)
                                     : random_polynomial(random, 1 + k % 3, 1 + k % 4);
    const BezierPatch q = k % 5 == 1 ? random_rational(random, 1 + k % 4, 1 + k % 2, 0.8, 1.2)
                                     : random_polynomial(random, 1 + k % 4, 1 + k % 2);
    const double ratio = k % 2 ? 1 : uniform(random, 1, 3);
    const Domain left{0, 2, 1, 4}, right{5, 6, -1, 1};
    const auto made = make_join({p, a, left}, {q, b, right}, ratio, k % 2 == 0);
    ASSERT_TRUE(made.ok()) << made.status().message();
    const JoinReport report = measured({p, a, left}, {*made, b, right});
    EXPECT_EQ(report.reversed, k % 2 == 0);
    EXPECT_LT(report.position_gap, 1e-14);
    ASSERT_TRUE(report.ratio.has_value()) << k;
    EXPECT_NEAR(*report.ratio, ratio, 1e-12);
    if (ratio == 1) {
      EXPECT_LT(report.derivative_gap, 1e-12);
    }
  }
}

TEST(Join, HighestDegreesAndAnyPlaceAndScale) {
  Random random(4);
  for (const bool weighted : {false, true})
    for (const auto& [size, distance] :
         {std::pair{1.0, 0.0}, {1e-6, 1e-6}, {1.0, 1e4}, {1e100, 1e100}, {1e-100, 0.0}}) {
      const Vec3 centre{distance, -distance, distance};
      std::vector<Vec3> net;
      for (int i = 0; i <= 15; ++i)
        for (int j = 0; j <= 15; ++j)
          net.push_back(centre + size * (Vec3{i / 15.0, j / 15.0, 0} + 0.02 * uniform_vector(random, -1, 1)));
      const BezierPatch p =
          weighted ? rational(15, 15, net, random_weights(random, 15, 15, 0.9, 1.1)) : polynomial(15, 15, net);
      const auto made = make_join({p, Side::v1}, {p, Side::v1}, 1);
      ASSERT_TRUE(made.ok()) << made.status().message();
      const JoinTolerances tolerances{.angle = 1e-5, .derivative = 1e-8};
      const JoinReport report = measured({p, Side::v1}, {*made, Side::v1}, tolerances);
      EXPECT_EQ(report.continuity, Continuity::c1) << size << " " << distance << " angle " << report.normal_angle;
      EXPECT_TRUE(report.sharp);
      EXPECT_EQ(report.position_gap, 0);
    }
}

TEST(Join, OneNormalWithoutOneRatioIsG1) {
  // Both in the plane z = 0; the speed across the border grows along it.
  const BezierPatch p = plane(1), q = polynomial(1, 1, {{2, 0, 0}, {2, 1, 0}, {3, 0, 0}, {4, 1.5, 0}});
  const JoinReport report = measured({p, Side::u1}, {q, Side::u0});
  EXPECT_EQ(report.continuity, Continuity::g1);
  EXPECT_FALSE(report.ratio.has_value());
  EXPECT_NEAR(report.derivative_gap, std::sqrt(1.25), 2e-3);
}

TEST(Join, GapsWithinToleranceAreClosed) {
  const BezierPatch p = plane(1), q = polynomial(1, 1, {{2, 0, 1e-7}, {2, 1, 1e-7}, {3, 0, 1e-7}, {3, 1, 1e-7}});
  EXPECT_EQ(measured({p, Side::u1}, {q, Side::u0}).continuity, Continuity::none);
  EXPECT_NEAR(measured({p, Side::u1}, {q, Side::u0}).position_gap, 1e-7, 1e-15);
  EXPECT_EQ(measured({p, Side::u1}, {q, Side::u0}, {.position = 1e-6}).continuity, Continuity::c1);
}

TEST(Join, MakingKeepsTheRestOfThePatch) {
  Random random(3);
  const BezierPatch p = random_polynomial(random, 3, 2), q = random_polynomial(random, 3, 2);
  const auto made = make_join({p, Side::u1}, {q, Side::u0}, 2);
  ASSERT_TRUE(made.ok());
  for (int j = 0; j <= 2; ++j) {
    EXPECT_EQ(made->point(0, j), p.point(3, j));
    EXPECT_EQ(made->point(1, j), p.point(3, j) + 0.5 * (p.point(3, j) - p.point(2, j)));
    EXPECT_EQ(made->point(2, j), q.point(2, j));
    EXPECT_EQ(made->point(3, j), q.point(3, j));
  }
}

TEST(Join, RefusesBadInput) {
  const BezierPatch p = plane(1);
  const auto code = [&](const JoinedPatch& a, const JoinedPatch& b, const JoinTolerances& t = {}) {
    return measure_join(a, b, t).status().code();
  };
  EXPECT_EQ(code({p, static_cast<Side>(4)}, {p, Side::u0}), StatusCode::invalid_argument);
  EXPECT_EQ(code({p, Side::u1}, {p, Side::u0, {1, 1, 0, 1}}), StatusCode::invalid_argument);
  EXPECT_EQ(code({p, Side::u1}, {p, Side::u0, {0, no_number, 0, 1}}), StatusCode::non_finite);
  EXPECT_EQ(code({p, Side::u1}, {p, Side::u0}, {.angle = no_number}), StatusCode::invalid_argument);
  EXPECT_EQ(code({p, Side::u1}, {p, Side::u0}, {.position = -1}), StatusCode::invalid_argument);
  for (const double k : {0.0, -1.0})
    EXPECT_EQ(make_join({p, Side::u1}, {p, Side::u0}, k).status().code(), StatusCode::invalid_argument);
  for (const double k : {no_number, std::numeric_limits<double>::infinity()})
    EXPECT_EQ(make_join({p, Side::u1}, {p, Side::u0}, k).status().code(), StatusCode::non_finite);
  const BezierPatch heavy = rational(1, 1, {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}}, {4, 4, 1, 1});
  EXPECT_EQ(make_join({heavy, Side::u1}, {p, Side::u0}, 1).status().code(), StatusCode::invalid_weight);
  EXPECT_TRUE(make_join({heavy, Side::u1}, {p, Side::u0}, 4).ok());
}

TEST(Join, DegeneratePatchesGiveNumbers) {
  const BezierPatch dot = polynomial(2, 2, std::vector<Vec3>(9)), p = plane(1);
  for (const BezierPatch& q : {dot, p}) {
    const JoinReport report = measured({dot, Side::u1}, {q, Side::u0});
    EXPECT_FALSE(std::isnan(report.normal_angle));
    EXPECT_FALSE(std::isnan(report.position_gap));
    EXPECT_LE(report.continuity, Continuity::c0);
  }
}

}}  // namespace tessera::test
