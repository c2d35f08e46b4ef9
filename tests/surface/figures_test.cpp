// Figures of the lectures that the surfaces come from: each is exact, and required to the last printed digit.

#include <cmath>

#include "support/lecture_points.h"
#include "support/random_patches.h"
#include "support/reference.h"
#include "support/ulp.h"

namespace tessera::test { namespace {

TEST(Figures, BicubicBezier) {
  const BezierPatch patch = polynomial(3, 3, lecture_points());

  const SurfaceJet jet = evaluate_jet(patch, 0.5, 0.5);
  EXPECT_EQ(jet.position, (Vec3{0.5, 0.6875, 0.15625}));
  EXPECT_EQ(jet.du, (Vec3{-0.375, -0.5625, -0.375}));
  EXPECT_EQ(jet.dv, (Vec3{-0.5625, -0.375, 0.375}));
  EXPECT_EQ(jet.duv, (Vec3{-1.125, -3.375, -1.125}));
  const Vec3 off_centre{0.44189453125, 0.85498046875, 0.44189453125};
  EXPECT_EQ(evaluate_jet(patch, 0.25, 0.75).position, off_centre);
  for (const auto evaluator : {de_casteljau, de_casteljau_bilinear, de_casteljau_rational}) {
    EXPECT_EQ(evaluator(patch, 0.5, 0.5), jet.position);
    EXPECT_EQ(evaluator(patch, 0.25, 0.75), off_centre);
  }
}

BezierPatch octant() {
  const double h = std::sqrt(0.5);
  const double w[] = {1, h, 1};
  std::vector<double> weights;
  for (const double a : w)
    for (const double b : w) weights.push_back(a * b);
  return rational(2, 2,
                  {{1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}},
                  weights);
}

TEST(Figures, RationalOctantIsOnTheSphere) {
  const BezierPatch patch = octant();
  for (const auto evaluator : {de_casteljau, de_casteljau_bilinear, de_casteljau_rational}) {
    EXPECT_TRUE(within_units(evaluator(patch, 0.5, 0.5), {0.5, 0.5, std::sqrt(0.5)}, double_unit, 2));
    for (int i = 0; i <= 64; ++i)
      for (int j = 0; j <= 64; ++j)
        EXPECT_NEAR(length(evaluator(patch, i / 64.0, j / 64.0)), 1, 6 * double_unit) << i << " " << j;
  }
}

TEST(Figures, RationalOctantHasRadialNormals) {
  const BezierPatch patch = octant();
  for (int i = 0; i <= 64; ++i)
    for (int j = 0; j <= 64; ++j) {
      const double u = i / 64.0, v = j / 64.0;
      const UnitNormal normal = unit_normal(patch, u, v);
      EXPECT_EQ(normal.kind, i == 64 ? NormalKind::limit : NormalKind::regular);
      // r_u runs up to the pole and r_v to the east: their product points inwards.
      EXPECT_TRUE(within_units(normal.direction, -de_casteljau(patch, u, v), double_unit, i > 60 ? 512 : 64))
          << u << " " << v;
    }
  EXPECT_EQ(unit_normal(patch, 1, 0.3).direction, (Vec3{0, 0, -1}));
}

TEST(Figures, SPieceHasItsMiddleOnTheChord) {
  const double heights[] = {0, 1, -1, 0};
  std::vector<Vec3> points;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) points.push_back({i / 3.0, j / 3.0, heights[i]});
  const BezierPatch patch = polynomial(3, 3, points);
  const double largest = std::sqrt(3) / 6;
  for (const double v : {0.0, 0.3, 1.0}) {
    EXPECT_EQ(de_casteljau(patch, 0.5, v).z, 0);
    EXPECT_NEAR(evaluate_jet(patch, 0.5, v).position.z, 0, double_unit);
    EXPECT_NEAR(de_casteljau(patch, 0.5 - largest, v).z, largest, 2 * double_unit);
    EXPECT_NEAR(evaluate_jet(patch, 0.5 - largest, v).du.z, 0, 16 * double_unit);
    for (int i = 0; i <= 1000; ++i) EXPECT_LE(std::abs(de_casteljau(patch, i / 1000.0, v).z), largest + double_unit);
  }
}

}}  // namespace tessera::test
