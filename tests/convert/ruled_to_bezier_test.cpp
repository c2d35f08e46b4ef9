// Ruled surfaces between Bezier, B-spline and NURBS curves as patches, exactly.

#include <cmath>

#include "support/borders.h"
#include "support/errors.h"
#include "support/ulp.h"
#include "tessera/convert.h"

namespace tessera::test { namespace {

struct Pair {
  BorderStyle first, second;
  int degree;  ///< expected along the curves
};

// Mixed degrees and knots, polynomial and rational, the straight lines along u and along v.
TEST(RuledToBezier, IsTheFormulaToRounding) {
  Random random(1);
  const Interval along{-1, 2};
  double largest = 0;
  for (const auto& [a, b, degree] : {Pair{{3, 2}, {3, 2}, 3},
                                     {{1, 0}, {5, 3}, 5},
                                     {{2, 3, true}, {3, 1}, 5},
                                     {{3, 1}, {2, 3, true}, 5},
                                     {{3, 2, true}, {2, 1, true}, 5},
                                     {{7, 2, true}, {7, 0, true}, 14}})
    for (const Direction straight : {Direction::u, Direction::v}) {
      const Curve first = curve_between(random, a.degree, a.inner, a.rational, {0, 0, 0}, {1, 0, 0}, along);
      const Curve second = curve_between(random, b.degree, b.inner, b.rational, {0, 1, 0}, {1, 1, 1}, along);
      const RuledSurface surface = value_of(RuledSurface::make(first, second, {2, 5}, straight));
      EXPECT_TRUE(surface.is_exact());
      const PatchGrid grid = value_of(to_bezier(surface));
      EXPECT_EQ(grid.domain(), surface.domain());
      EXPECT_EQ(grid.fit_error().distance, 0);
      EXPECT_TRUE(grid.fit_error().certified);
      EXPECT_EQ(grid.patches()[0].degree_u(), straight == Direction::v ? degree : 1);
      EXPECT_EQ(grid.patches()[0].degree_v(), straight == Direction::v ? 1 : degree);
      EXPECT_TRUE(shares_borders(grid));
      largest = std::max(largest, conversion_error(surface, grid));
    }
  RecordProperty("units", std::to_string(largest));
  EXPECT_LT(largest, 8);
}

TEST(RuledToBezier, UnclampedCurvesAndParts) {
  Random random(2);
  for (const bool rational : {false, true}) {
    const Curve whole = random_curve(random, 3, {4, false}, rational);
    const Interval d = whole.domain(), part{d.from + 0.3 * (d.to - d.from), d.from + 0.8 * (d.to - d.from)};
    const Curve first = rational ? value_of(Curve::nurbs(3, whole.points(), whole.weights(), whole.knots(), part))
                                 : value_of(Curve::b_spline(3, whole.points(), whole.knots(), part));
    const Curve second = curve_between(random, 2, 1, false, {0, 0, 0}, {1, 1, 1}, part);
    const RuledSurface surface = value_of(RuledSurface::make(first, second));
    EXPECT_LT(conversion_error(surface, value_of(to_bezier(surface))), 8);
  }
}

/// A quarter of the unit circle at a height.
Curve arc(double height) {
  return value_of(Curve::bezier(std::vector<Vec3>{{1, 0, height}, {1, 1, height}, {0, 1, height}},
                                std::vector<double>{1, std::sqrt(2.0) / 2, 1}));
}

TEST(RuledToBezier, EqualWeightFunctionsAreLoftedAsTheyStand) {
  const PatchGrid grid = value_of(to_bezier(value_of(RuledSurface::make(arc(0), arc(2)))));
  ASSERT_EQ(grid.patches().size(), 1u);
  const BezierPatch& patch = grid.patches()[0];
  EXPECT_EQ(patch.degree_u(), 2);
  EXPECT_EQ(patch.weight(1, 0), std::sqrt(2.0) / 2);
  EXPECT_EQ(patch.point(1, 1), (Vec3{1, 1, 2}));
  for (const double u : {0.0, 0.2, 0.5, 1.0})
    for (const double v : {0.0, 0.3, 1.0}) {
      const Vec3 p = grid.evaluate_jet(u, v)->position;
      EXPECT_NEAR(std::hypot(p.x, p.y), 1, 4 * double_unit);
    }
  // An arc raised to a higher degree is recognised as having the same weights.
  const Curve higher = value_of(elevate_degree(arc(2), 1));
  const RuledSurface mixed = value_of(RuledSurface::make(arc(0), higher));
  const PatchGrid cubic = value_of(to_bezier(mixed));
  EXPECT_EQ(cubic.patches()[0].degree_u(), 3);
  EXPECT_LT(conversion_error(mixed, cubic), 8);
}

// Lofting homogeneous nets changes the speed in v: 0.059 between an arc and the parabola of its polygon at height 1.5.
TEST(RuledToBezier, AnArcAndAParabolaKeepTheirSpeed) {
  const Curve parabola = value_of(Curve::bezier(std::vector<Vec3>{{1, 0, 1.5}, {1, 1, 1.5}, {0, 1, 1.5}}));
  const RuledSurface surface = value_of(RuledSurface::make(arc(0), parabola));
  const PatchGrid grid = value_of(to_bezier(surface));
  EXPECT_EQ(grid.patches()[0].degree_u(), 4);
  EXPECT_LT(conversion_error(surface, grid), 8);
  const double w = std::sqrt(2.0) / 2;
  const BezierPatch lofted =
      rational(2, 1, {{1, 0, 0}, {1, 0, 1.5}, {1, 1, 0}, {1, 1, 1.5}, {0, 1, 0}, {0, 1, 1.5}}, {1, 1, w, 1, 1, 1});
  double gap = 0;
  for (int k = 0; k <= 100; ++k)
    gap = std::max(gap,
                   length(evaluate_jet(lofted, 0.5, k / 100.0).position - grid.evaluate_jet(0.5, k / 100.0)->position));
  EXPECT_NEAR(gap, 0.059, 5e-4);
}

TEST(RuledToBezier, BordersAreTheCurvesPoints) {
  Random random(3);
  const Curve first = curve_between(random, 3, 0, true, {0, 0, 0}, {1, 0, 0});
  const Curve second = curve_between(random, 3, 0, false, {0, 1, 0}, {1, 1, 1});
  const PatchGrid grid = value_of(to_bezier(value_of(RuledSurface::make(first, second))));
  const BezierPatch& patch = grid.patches()[0];
  EXPECT_EQ(patch.point(0, 0), first.points().front());
  EXPECT_EQ(patch.point(patch.degree_u(), 0), first.points().back());
  EXPECT_EQ(patch.point(0, 1), second.points().front());
  EXPECT_EQ(patch.point(patch.degree_u(), 1), second.points().back());
}

TEST(RuledToBezier, Refuses) {
  Random random(4);
  const Curve eight = curve_between(random, 8, 0, true, {0, 0, 0}, {1, 0, 0});
  const Curve nine = curve_between(random, 9, 0, true, {0, 1, 0}, {1, 1, 0});
  expect_refused(to_bezier(value_of(RuledSurface::make(eight, nine))), StatusCode::unsupported_degree, -1,
                 "degree 17 in u, above 15: the curves along u are rational of degree 8 and rational of degree 9");
  const std::vector<Vec3> points{{0, 0, 0}, {1, 0, 0}};
  const Curve tiny = value_of(Curve::bezier(points, std::vector<double>{1e-60, 1}));
  const Curve other = value_of(Curve::bezier(points, std::vector<double>{1e-70, 1}));
  expect_refused(to_bezier(value_of(RuledSurface::make(tiny, other))), StatusCode::invalid_weight, 0, "patch [0][0]");
}

TEST(RuledToBezier, HugeCurvesStayFinite) {
  const Curve first = quadratic({0, 0, 0}, {1e300, 0, 0}, {}), second = quadratic({0, 1e300, 0}, {1e300, 0, 0}, {});
  const PatchGrid grid = value_of(to_bezier(value_of(RuledSurface::make(first, second))));
  EXPECT_EQ(grid.evaluate_jet(0.5, 0.5)->position, (Vec3{5e299, 5e299, 0}));
}

}}  // namespace tessera::test
