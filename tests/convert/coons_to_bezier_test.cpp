// Coons patches between Bezier, B-spline and NURBS curves as patches, exactly.

#include <cmath>

#include "support/borders.h"
#include "support/errors.h"
#include "support/random_hermite.h"
#include "support/ulp.h"

namespace tessera::test { namespace {

Blend quintic() {
  return value_of(
      Blend::polynomial(std::vector<double>{1, 0, 0, -10, 15, -6}, std::vector<double>{0, 0, 0, 10, -15, 6}));
}

struct Case {
  std::array<BorderStyle, 4> styles;  ///< C1, C2, D1, D2
  Blend f, g;
  int degree_u, degree_v;  ///< expected
};

std::vector<Case> cases() {
  const Blend linear = Blend::linear(), cubic = Blend::cubic();
  const BorderStyle arc{2, 0, true}, spline{3, 2}, nurbs{2, 2, true};
  return {{{{{3}, {3}, {3}, {3}}}, linear, linear, 3, 3},
          {{{{1}, {2}, {5}, {4}}}, linear, cubic, 2, 5},
          {{{{1}, {1}, {1}, {1}}}, cubic, quintic(), 3, 5},
          {{{spline, {4, 1}, {2, 3}, spline}}, linear, cubic, 4, 3},
          {{{arc, {3}, {3}, {3}}}, linear, linear, 5, 3},      // W of degree 2: max(2 + 3, 2 + 1)
          {{{{1}, arc, {3}, {3}}}, cubic, linear, 5, 3},       // max(2 + 1, 2 + 3)
          {{{arc, nurbs, {3}, spline}}, linear, cubic, 5, 3},  // W of degree 4
          {{{nurbs, {3, 1, true}, {2, 0, true}, {2, 3, true}}}, cubic, cubic, 8, 7},
          {{{{5, 1, true}, {5, 0, true}, {4, 1, true}, {6, 0, true}}}, quintic(), quintic(), 15, 15}};
}

TEST(CoonsToBezier, IsTheFormulaToRounding) {
  Random random(1);
  double largest = 0;
  for (const Case& c : cases())
    for (const Domain& domain : {Domain{}, Domain{-2, 1, 5, 5.5}}) {
      const CoonsPatch patch = coons(random_borders(random, c.styles, domain), {.f = c.f, .g = c.g});
      EXPECT_TRUE(patch.is_exact());
      const PatchGrid grid = value_of(to_bezier(patch));
      EXPECT_EQ(grid.domain(), patch.domain());
      EXPECT_EQ(grid.fit_error().distance, 0);
      EXPECT_TRUE(grid.fit_error().certified);
      EXPECT_EQ(grid.patches()[0].degree_u(), c.degree_u);
      EXPECT_EQ(grid.patches()[0].degree_v(), c.degree_v);
      EXPECT_EQ(grid.patches().size(), grid.count_u() * grid.count_v());
      EXPECT_TRUE(shares_borders(grid));
      largest = std::max(largest, conversion_error(patch, grid));
    }
  RecordProperty("units", std::to_string(largest));
  EXPECT_LT(largest, 8);
}

TEST(CoonsToBezier, MergesTheKnotsOfOppositeBorders) {
  Random random(2);
  const CoonsPatch patch = coons(random_borders(random, {{{3, 2}, {2, 3}, {3, 0}, {1, 1}}}));
  const PatchGrid grid = value_of(to_bezier(patch));
  EXPECT_EQ(grid.count_u(), 6u);
  EXPECT_EQ(grid.count_v(), 2u);
  for (const double knot : std::get<Curve>(patch.borders().c2).knots())
    EXPECT_TRUE(std::ranges::binary_search(grid.breaks_u(), knot));
}

// If a border has the degree of the patch and its weights, its points are those of the border, bit for bit.
TEST(CoonsToBezier, BordersKeepTheirBits) {
  Random random(3);
  const CoonsPatch patch = coons(random_borders(random, {{{3}, {3}, {3}, {3}}}), Blend::cubic());
  const PatchGrid grid = value_of(to_bezier(patch));
  const BezierPatch& bezier = grid.patches()[0];
  const auto points = [](const BorderCurve& border) { return std::get<Curve>(border).points(); };
  const CoonsBorders& b = patch.borders();
  for (int i = 0; i <= 3; ++i) {
    const std::size_t k = static_cast<std::size_t>(i);
    EXPECT_EQ(bezier.point(i, 0), points(b.c1)[k]);
    EXPECT_EQ(bezier.point(i, 3), points(b.c2)[k]);
    EXPECT_EQ(bezier.point(0, i), points(b.d1)[k]);
    EXPECT_EQ(bezier.point(3, i), points(b.d2)[k]);
  }
}

CoonsBorders square_borders() {
  const auto line = [](const Vec3& from, const Vec3& to) {
    return value_of(Curve::bezier(std::vector<Vec3>{from, to}));
  };
  return {line({0, 0, 0}, {1, 0, 0}), line({0, 1, 0}, {1, 1, 2}), line({0, 0, 0}, {0, 1, 0}),
          line({1, 0, 0}, {1, 1, 2})};
}

TEST(CoonsToBezier, Figures) {
  const PatchGrid bilinear = value_of(to_bezier(coons(square_borders())));
  EXPECT_EQ(bilinear.patches()[0].degree_u(), 1);
  EXPECT_EQ(bilinear.evaluate_jet(0.25, 0.75)->position, (Vec3{0.25, 0.75, 0.375}));
  const PatchGrid cubic = value_of(to_bezier(coons(square_borders(), Blend::cubic())));
  EXPECT_TRUE(within_units(cubic.evaluate_jet(0.25, 0.75)->position, {0.25, 0.75, 0.392578125}, double_unit, 1));
  const CoonsBorders saddle{quadratic({0, 0, 1}, {1, 0, -1}, {0, 1, 0}), quadratic({1, -1, 2}, {1, 0, -1}, {0, 1, 0}),
                            quadratic({0, 0, 1}, {1, 0, 1}, {0, -1, 0}), quadratic({1, 1, 0}, {1, 0, 1}, {0, -1, 0})};
  const PatchGrid grid = value_of(to_bezier(coons(saddle)));
  for (int i = 0; i <= 16; ++i)
    for (int j = 0; j <= 16; ++j) {
      const double u = i / 16.0, v = j / 16.0;
      EXPECT_EQ(grid.evaluate_jet(u, v)->position, (Vec3{u + v, u * u - v * v, 1 - u + v}));
    }
}

/// The four cubic borders of a patch of one bicubic.
CoonsBorders borders_of(const PatchGrid& grid) {
  const BezierPatch& patch = grid.patches()[0];
  const auto curve = [&](int i0, int j0, int di, int dj) {
    std::vector<Vec3> points;
    for (int k = 0; k <= 3; ++k) points.push_back(patch.point(i0 + k * di, j0 + k * dj));
    return value_of(Curve::bezier(points));
  };
  return {curve(0, 0, 1, 0), curve(0, 3, 1, 0), curve(0, 0, 0, 1), curve(3, 0, 0, 1)};
}

void expect_same_net(const PatchGrid& a, const PatchGrid& b) {
  for (std::size_t k = 0; k < 16; ++k)
    EXPECT_TRUE(within_units(a.patches()[0].points()[k], b.patches()[0].points()[k], double_unit, 8)) << k;
}

// The bilinearly blended patch of cubic borders is the bicubic with Adini's twists (Farin, sec. 22.4); the partially
// bicubic one has none: Ferguson's.
TEST(CoonsToBezier, OfCubicBordersAreAdinisAndFergusonsPatches) {
  Random random(4);
  for (int copy = 0; copy < 10; ++copy) {
    HermitePatch::OpenCorners corners;
    for (auto& corner : corners)
      corner = {uniform_vector(random, -1, 1), uniform_vector(random, -1, 1), uniform_vector(random, -1, 1)};
    const PatchGrid adini = value_of(to_bezier(value_of(HermitePatch::adini(corners))));
    const PatchGrid ferguson = value_of(to_bezier(value_of(HermitePatch::ferguson(corners))));
    expect_same_net(value_of(to_bezier(coons(borders_of(adini)))), adini);
    expect_same_net(value_of(to_bezier(coons(borders_of(ferguson), Blend::cubic()))), ferguson);
  }
}

// The patches follow the formula, whatever part of the gap closing_tolerance accepts.
TEST(CoonsToBezier, ForgivenGapsStay) {
  CoonsBorders borders = square_borders();
  borders.d1 = quadratic({0, 1e-4, 0}, {0, 1, 0}, {});
  borders.c2 = quadratic({0, 1, 0}, {1, 0, 2 + 1e-4}, {});
  const CoonsPatch patch = coons(borders, {.f = Blend::cubic(), .closing_tolerance = 1e-3});
  EXPECT_LT(conversion_error(patch, value_of(to_bezier(patch))), 8);
}

TEST(CoonsToBezier, Refuses) {
  Random random(5);
  const auto refused = [&](const std::array<BorderStyle, 4>& styles, const char* words) {
    expect_refused(to_bezier(coons(random_borders(random, styles), Blend::cubic())), StatusCode::unsupported_degree, -1,
                   words);
  };
  const BorderStyle seven{7, 0, true}, six{6, 0, true};
  refused({{seven, six, {3}, {3}}},
          "degree 16 in u, above 15: the curves along u are rational of degree 7 and rational of "
          "degree 6, the blending functions of degree 3");
  refused({{{3}, {3}, seven, six}}, "degree 16 in v");
  CoonsBorders huge = square_borders();
  const auto line = [](const Vec3& from, const Vec3& middle, const Vec3& to) {
    return value_of(Curve::bezier(std::vector<Vec3>{from, middle, to}));
  };
  const Vec3 far{1.5e308, 0, 0};
  huge = {line({0, 0, 0}, far, {1, 0, 0}), line({0, 1, 0}, far, {1, 1, 2}), line({0, 0, 0}, far, {0, 1, 0}),
          line({1, 0, 0}, far, {1, 1, 2})};
  expect_refused(to_bezier(coons(huge)), StatusCode::non_finite, 4, "patch [0][0]");
}

}}  // namespace tessera::test
