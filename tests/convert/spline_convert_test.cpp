#include "tessera/convert.h"

#include <cmath>
#include <limits>

#include "support/random_splines.h"
#include "support/ulp.h"

namespace tessera::test { namespace {

const std::vector<KnotStyle> knot_styles{{0}, {3}, {3, true, true}, {2, false, false}, {2, false, true}};

void expect_same(const Curve& a, const Curve& b, Random& random) {
  EXPECT_EQ(a.domain(), b.domain());
  EXPECT_EQ(a.is_rational(), b.is_rational());
  const double unit = double_unit * largest_coefficient(a.points());
  for (const double t : sample_parameters(random, a.knots(), a.domain().from, a.domain().to, 5))
    EXPECT_TRUE(within_units(evaluate_jet(b, t).position, evaluate_jet(a, t).position, unit, 8))
        << a.degree() << " " << t;
}
void expect_same(const BSplineSurface& a, const BSplineSurface& b, Random& random) {
  EXPECT_EQ(a.domain(), b.domain());
  const double unit = double_unit * largest_coefficient(a.points());
  for (const double u : sample_parameters(random, a.knots_u(), a.domain().u0, a.domain().u1, 2))
    for (const double v : sample_parameters(random, a.knots_v(), a.domain().v0, a.domain().v1, 2))
      EXPECT_TRUE(within_units(evaluate_jet(b, u, v).position, evaluate_jet(a, u, v).position, unit, 8))
          << u << " " << v;
}

template <class Body>
void for_all_curves(int most, Body body) {
  Random random(1);
  for (int degree = 1; degree <= most; ++degree)
    for (const KnotStyle& style : knot_styles)
      for (const bool rational : {false, true}) body(random, random_curve(random, degree, style, rational));
}

TEST(SplineConvert, KnotInsertionKeepsTheCurve) {
  for_all_curves(max_degree, [](Random& random, const Curve& curve) {
    const Interval d = curve.domain();
    std::vector<double> knots{uniform(random, d.from, d.to), uniform(random, d.from, d.to)};
    if (curve.degree() > 1) knots.push_back(knots[0]);
    const Curve more = value_of(insert_knots(curve, knots));
    EXPECT_EQ(more.knots().size(), curve.knots().size() + knots.size());
    EXPECT_TRUE(std::ranges::is_sorted(more.knots()));
    expect_same(curve, more, random);
  });
}

TEST(SplineConvert, InsertionToFullMultiplicityGivesTheBezierPieces) {
  for_all_curves(7, [](Random& random, const Curve& curve) {
    const Curve ends = value_of(clamp_ends(curve));
    std::vector<double> knots;
    for (const double t : ends.knots())
      if (t > ends.domain().from && t < ends.domain().to && (knots.empty() || knots.back() != t))
        for (std::size_t k = static_cast<std::size_t>(std::ranges::count(ends.knots(), t));
             k < static_cast<std::size_t>(ends.degree()); ++k)
          knots.push_back(t);
    const Curve pieces = value_of(insert_knots(ends, knots));
    const BezierPieces expected = value_of(to_bezier(curve));
    ASSERT_EQ(pieces.points().size(), expected.points.size());
    for (std::size_t k = 0; k < expected.points.size(); ++k)
      EXPECT_TRUE(within_units(pieces.points()[k], expected.points[k], double_unit, 6)) << ends.degree();
    expect_same(curve, pieces, random);
  });
}

TEST(SplineConvert, ClampingKeepsTheCurveAndInterpolatesItsEnds) {
  for_all_curves(max_degree, [](Random& random, const Curve& curve) {
    const Curve ends = value_of(clamp_ends(curve));
    const std::size_t p = static_cast<std::size_t>(curve.degree());
    EXPECT_EQ(ends.knots().front(), ends.knots()[p]);
    EXPECT_EQ(ends.knots().back(), ends.knots()[ends.knots().size() - p - 1]);
    EXPECT_EQ(evaluate_jet(ends, ends.domain().from).position, ends.points().front());
    EXPECT_EQ(evaluate_jet(ends, ends.domain().to).position, ends.points().back());
    expect_same(curve, ends, random);
  });
}

TEST(SplineConvert, ClampingASmallerDomain) {
  Random random(2);
  for (const bool rational : {false, true}) {
    const Curve whole = random_curve(random, 3, {4, false, true}, rational);
    const Interval d = whole.domain(), part{d.from + 0.3 * (d.to - d.from), d.from + 0.8 * (d.to - d.from)};
    const Curve cut = rational ? value_of(Curve::nurbs(3, whole.points(), whole.weights(), whole.knots(), part))
                               : value_of(Curve::b_spline(3, whole.points(), whole.knots(), part));
    const Curve ends = value_of(clamp_ends(cut));
    EXPECT_EQ(ends.domain(), part);
    EXPECT_EQ(ends.knots().front(), part.from);
    expect_same(cut, ends, random);
  }
}

TEST(SplineConvert, DegreeElevationKeepsTheCurve) {
  for_all_curves(10, [](Random& random, const Curve& curve) {
    for (const int by : {0, 1, 3}) {
      const Curve higher = value_of(elevate_degree(curve, by));
      EXPECT_EQ(higher.degree(), curve.degree() + by);
      expect_same(curve, higher, random);
    }
  });
}

TEST(SplineConvert, DegreeElevationOfABezierCurveIsTheFormula) {
  Random random(3);
  for (int m = 1; m < max_degree; ++m) {
    const std::vector<Vec3> points = random_cloud(random, static_cast<std::size_t>(m) + 1);
    const Curve higher = value_of(elevate_degree(value_of(Curve::bezier(points)), 1));
    for (int i = 0; i <= m + 1; ++i) {
      const double share = i / (m + 1.0);
      const Vec3 before = i > 0 ? points[static_cast<std::size_t>(i - 1)] : Vec3{};
      const Vec3 after = i <= m ? points[static_cast<std::size_t>(i)] : Vec3{};
      EXPECT_TRUE(within_units(higher.points()[static_cast<std::size_t>(i)], share * before + (1 - share) * after,
                               double_unit, 2));
    }
  }
}

TEST(SplineConvert, UnevenKnotsAreElevatedToo) {
  Random random(4);
  const std::vector<double> knots{0, 0, 0, 0, 1e-5, 0.3, 0.3, 0.300001, 2, 2, 2, 2};
  const Curve curve = value_of(Curve::b_spline(3, random_cloud(random, 8), knots));
  expect_same(curve, value_of(elevate_degree(curve, 2)), random);
}

TEST(SplineConvert, SurfacesAreRefinedClampedAndElevated) {
  Random random(5);
  for (const auto& [p, q] : {std::pair{1, 3}, {3, 2}, {5, 5}})
    for (std::size_t k = 0; k < knot_styles.size(); ++k)
      for (const bool rational : {false, true}) {
        const BSplineSurface s =
            random_surface(random, p, q, knot_styles[k], knot_styles[(k + 3) % knot_styles.size()], rational);
        const std::vector<double> u{s.domain().u_at(0.3)}, v{s.domain().v_at(0.45), s.domain().v_at(0.9)};
        const BSplineSurface more = value_of(insert_knots(s, u, v));
        EXPECT_EQ(more.count_u(), s.count_u() + 1);
        EXPECT_EQ(more.count_v(), s.count_v() + 2);
        expect_same(s, more, random);
        const BSplineSurface ends = value_of(clamp_ends(s));
        expect_same(s, ends, random);
        EXPECT_EQ(evaluate_jet(ends, s.domain().u0, s.domain().v1).position, ends.point(0, ends.count_v() - 1));
        const BSplineSurface higher = value_of(elevate_degree(s, 2, 1));
        EXPECT_EQ(higher.degree_u(), p + 2);
        EXPECT_EQ(higher.degree_v(), q + 1);
        expect_same(s, higher, random);
      }
}

TEST(SplineConvert, PointsThatStayKeepTheirBits) {
  Random random(6);
  const Curve curve = random_curve(random, 2, {6}, true);
  const double t = curve.domain().to - 1e-3;  // in the last span: the points before it stay
  const Curve more = value_of(insert_knots(curve, std::vector<double>{t}));
  for (std::size_t i = 0; i + 2 < curve.points().size(); ++i) EXPECT_EQ(more.points()[i], curve.points()[i]);
  EXPECT_EQ(more.points().back(), curve.points().back());
}

TEST(SplineConvert, CompatibleCurvesHaveOneDegreeAndOneSetOfKnots) {
  Random random(7);
  const auto over = [&](int degree, const std::vector<double>& inner, bool rational) {
    std::vector<double> knots(static_cast<std::size_t>(degree) + 1, -1.0);
    knots.insert(knots.end(), inner.begin(), inner.end());
    knots.insert(knots.end(), static_cast<std::size_t>(degree) + 1, 4.0);
    const std::size_t count = knots.size() - static_cast<std::size_t>(degree) - 1;
    const std::vector<Vec3> points = random_cloud(random, count);
    return rational ? value_of(Curve::nurbs(degree, points, random_positive(random, count), knots))
                    : value_of(Curve::b_spline(degree, points, knots));
  };
  for (const bool rational : {false, true}) {
    const Curve a = over(2, {0, 0, 1.5}, rational), b = over(4, {0, 1, 1, 3}, false);
    const auto [c, d] = value_of(make_compatible(a, b));
    EXPECT_EQ(c.degree(), 4);
    EXPECT_EQ(d.degree(), 4);
    EXPECT_TRUE(std::ranges::equal(c.knots(), d.knots()));
    EXPECT_EQ(c.points().size(), d.points().size());
    expect_same(a, c, random);
    expect_same(b, d, random);
  }
  const Result<std::pair<Curve, Curve>> apart =
      make_compatible(over(2, {}, false), value_of(Curve::bezier(random_cloud(random, 3))));
  EXPECT_EQ(apart.status().code(), StatusCode::invalid_argument);
  EXPECT_NE(apart.status().message().find("[-1, 4] and [0, 1]"), std::string::npos) << apart.status().message();
}

TEST(SplineConvert, BadInputIsNamed) {
  const std::vector<Vec3> points{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}};
  const Curve curve = value_of(Curve::bezier(points));
  const auto insert = [&](std::vector<double> knots) { return insert_knots(curve, knots).status(); };
  EXPECT_TRUE(insert({}).ok());
  EXPECT_TRUE(insert({0.5, 0.5}).ok());
  EXPECT_EQ(insert({0.5, 0.5, 0.5}).code(), StatusCode::invalid_argument);
  EXPECT_EQ(insert({0.5, 0}).code(), StatusCode::invalid_argument);
  EXPECT_EQ(insert({0.5, 0}).index(), 1);
  EXPECT_EQ(insert({2}).code(), StatusCode::invalid_argument);
  EXPECT_EQ(insert({std::numeric_limits<double>::quiet_NaN()}).code(), StatusCode::non_finite);
  EXPECT_EQ(elevate_degree(curve, -1).status().code(), StatusCode::invalid_argument);
  EXPECT_EQ(elevate_degree(curve, 14).status().code(), StatusCode::unsupported_degree);
  EXPECT_EQ(elevate_degree(curve, std::numeric_limits<int>::max()).status().code(), StatusCode::unsupported_degree);
}

}}  // namespace tessera::test
