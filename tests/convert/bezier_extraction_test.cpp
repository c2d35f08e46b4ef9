#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "support/allocations.h"
#include "support/lecture_points.h"
#include "support/random_splines.h"
#include "support/ulp.h"
#include "tessera/convert.h"
#include "tessera/nurbs_surface.h"

namespace tessera::test { namespace {

const std::vector<KnotStyle> extracted_styles{{0}, {3}, {3, true, true}, {2, false, false}, {2, false, true}};

void expect_same_patches(const BSplineSurface& s, const PatchGrid& grid, Random& random, double limit) {
  const double unit = double_unit * largest_coefficient(s.points());
  EXPECT_EQ(grid.domain(), s.domain());
  for (const double u : sample_parameters(random, s.knots_u(), s.domain().u0, s.domain().u1, 2))
    for (const double v : sample_parameters(random, s.knots_v(), s.domain().v0, s.domain().v1, 2)) {
      const SurfaceJet jet = *grid.evaluate_jet(u, v);
      const SurfaceJet expected = evaluate_jet(s, u, v);
      EXPECT_TRUE(within_units(jet.position, expected.position, unit, limit))
          << s.degree_u() << " " << s.degree_v() << " at " << u << " " << v;
      const double slope = 1 + max_abs(expected.du) + max_abs(expected.dv);
      EXPECT_LT(max_abs(jet.du - expected.du) + max_abs(jet.dv - expected.dv), 1e-11 * slope);
      const double bend = slope * slope + max_abs(expected.duu) + max_abs(expected.duv) + max_abs(expected.dvv);
      EXPECT_LT(max_abs(jet.duv - expected.duv), 1e-10 * bend);
    }
}

TEST(BezierExtraction, ReproducesTheSurface) {
  Random random(1);
  for (const auto& [p, q] : {std::pair{1, 1}, {2, 3}, {3, 3}, {5, 4}, {8, 1}, {15, 15}})
    for (std::size_t k = 0; k < extracted_styles.size(); ++k)
      for (const bool rational : {false, true}) {
        const BSplineSurface s = random_surface(random, p, q, extracted_styles[k],
                                                extracted_styles[(k + 3) % extracted_styles.size()], rational);
        expect_same_patches(s, value_of(to_bezier(s)), random, 8);
      }
}

/// Bezier points in long double: f(a, .., b, ..) by de Boor's algorithm with one argument per step, on the definition's
/// knots.
std::vector<Real> exact_weights(const BSplineSurface& s, std::size_t span, Real a, Real b, int i) {
  const int p = s.degree_u();
  std::vector<Real> result;
  for (int k = 0; k <= p; ++k) {
    std::vector<Real> d(static_cast<std::size_t>(p) + 1, 0);
    d[static_cast<std::size_t>(k)] = 1;
    for (int r = 1; r <= p; ++r) {
      const Real t = r <= i ? b : a;
      for (int j = p; j >= r; --j) {
        const std::size_t at = span - static_cast<std::size_t>(p) + static_cast<std::size_t>(j);
        const Real left = s.knots_u()[at], right = s.knots_u()[at + static_cast<std::size_t>(p - r + 1)];
        const std::size_t n = static_cast<std::size_t>(j);
        d[n] = ((right - t) * d[n - 1] + (t - left) * d[n]) / (right - left);
      }
    }
    result.push_back(d.back());
  }
  return result;
}

TEST(BezierExtraction, ControlPointsAreRightToOneUnit) {
  Random random(2);
  for (const int p : {1, 2, 3, 5, 9, 15}) {
    const BSplineSurface s = random_surface(random, p, 1, {4, false, true}, {0}, false);
    const PatchGrid grid = value_of(to_bezier(s));
    for (std::size_t patch = 0; patch < grid.count_u(); ++patch) {
      const double a = grid.breaks_u()[patch], b = grid.breaks_u()[patch + 1];
      const std::size_t span = reference_span(s.knots_u(), a, s.domain().u1);
      for (int i = 0; i <= p; ++i) {
        const std::vector<Real> weights = exact_weights(s, span, a, b, i);
        RealVec3 sum;
        for (std::size_t k = 0; k < weights.size(); ++k) {
          const Vec3& point = s.point(span - static_cast<std::size_t>(p) + k, 1);
          sum = sum + weights[k] * RealVec3{point.x, point.y, point.z};
        }
        EXPECT_TRUE(within_units(grid.patch(patch, 0).point(i, 1), sum.rounded(), double_unit, 1.5)) << p << " " << i;
      }
    }
  }
}

TEST(BezierExtraction, NeighboursShareBordersByBits) {
  Random random(3);
  for (const bool rational : {false, true}) {
    const BSplineSurface s = random_surface(random, 3, 4, {5, false, true}, {4, true, true}, rational);
    const PatchGrid grid = value_of(to_bezier(s));
    for (std::size_t a = 0; a < grid.count_u(); ++a)
      for (std::size_t b = 0; b < grid.count_v(); ++b) {
        const BezierPatch& patch = grid.patch(a, b);
        EXPECT_EQ(patch.is_rational(), rational);
        for (int j = 0; a > 0 && j <= 4; ++j) {
          EXPECT_EQ(patch.point(0, j), grid.patch(a - 1, b).point(3, j));
          EXPECT_EQ(patch.weight(0, j), grid.patch(a - 1, b).weight(3, j));
        }
        for (int i = 0; b > 0 && i <= 3; ++i) {
          EXPECT_EQ(patch.point(i, 0), grid.patch(a, b - 1).point(i, 4));
          EXPECT_EQ(patch.weight(i, 0), grid.patch(a, b - 1).weight(i, 4));
        }
      }
  }
}

TEST(BezierExtraction, FullMultiplicityKeepsTheBits) {
  const BSplineSurface s = value_of(make_nurbs_torus({{0.1, 0.2, 0.3}, {1, 1, 3}, {1, 0, 0}}, 3, 1.1));
  const PatchGrid grid = value_of(to_bezier(s));
  ASSERT_EQ(grid.patches().size(), 16u);
  for (std::size_t a = 0; a < 4; ++a)
    for (std::size_t b = 0; b < 4; ++b)
      for (int i = 0; i <= 2; ++i)
        for (int j = 0; j <= 2; ++j) {
          const std::size_t row = 2 * a + static_cast<std::size_t>(i), column = 2 * b + static_cast<std::size_t>(j);
          EXPECT_EQ(grid.patch(a, b).point(i, j), s.point(row, column));
          EXPECT_EQ(grid.patch(a, b).weight(i, j), s.weight(row, column));
        }
}

TEST(BezierExtraction, RationalIsDecidedOnceASurface) {
  // The weights of the first patch are all equal; it stays rational like its neighbour.
  const std::vector<double> u{0, 0, 1, 2, 2}, v{0, 0, 1, 1};
  const std::vector<Vec3> points{{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}, {2, 0, 0}, {2, 1, 1}};
  const BSplineSurface s =
      value_of(BSplineSurface::rational(1, u, 1, v, points, std::vector<double>{2, 2, 2, 2, 2, 3}));
  const PatchGrid grid = value_of(to_bezier(s));
  EXPECT_TRUE(grid.patch(0, 0).is_rational());
  EXPECT_TRUE(grid.patch(1, 0).is_rational());
}

TEST(BezierExtraction, SpheresStayRound) {
  for (const CircleArcs arcs : {CircleArcs::three, CircleArcs::four}) {
    const PatchGrid grid = value_of(to_bezier(value_of(make_nurbs_sphere({}, 1, arcs))));
    for (int i = 0; i <= 60; ++i)
      for (int j = 0; j <= 60; ++j)
        EXPECT_NEAR(length(grid.evaluate_jet(i / 60.0, j / 60.0)->position), 1, 4 * double_unit) << i << " " << j;
  }
}

TEST(Figures, NurbsOfFivePointsMakesFourPatches) {
  Random random(4);
  const std::vector<double> knots{0, 0, 0, 0, 0.5, 1, 1, 1, 1};
  const std::vector<Vec3> points = random_cloud(random, 25);
  const BSplineSurface plain = value_of(BSplineSurface::polynomial(3, knots, 3, knots, points));
  const BSplineSurface ones =
      value_of(BSplineSurface::rational(3, knots, 3, knots, points, std::vector<double>(25, 1.0)));
  const PatchGrid grid = value_of(to_bezier(plain)), same = value_of(to_bezier(ones));
  ASSERT_EQ(grid.patches().size(), 4u);
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_EQ(grid.patches()[k].degree_u(), 3);
    EXPECT_EQ(grid.patches()[k].degree_v(), 3);
    EXPECT_FALSE(same.patches()[k].is_rational());
    EXPECT_TRUE(std::ranges::equal(grid.patches()[k].points(), same.patches()[k].points()));
  }
  const BSplineSurface nurbs =
      value_of(BSplineSurface::rational(3, knots, 3, knots, points, random_positive(random, 25)));
  expect_same_patches(nurbs, value_of(to_bezier(nurbs)), random, 8);
}

TEST(Figures, UniformBSplinePatchConverts) {
  const std::vector<double> knots{-3, -2, -1, 0, 1, 2, 3, 4};
  const PatchGrid grid =
      value_of(to_bezier(value_of(BSplineSurface::polynomial(3, knots, 3, knots, lecture_points()))));
  ASSERT_EQ(grid.patches().size(), 1u);
  EXPECT_TRUE(within_units(grid.evaluate_jet(0.3, 0.6)->position,
                           {3184649 / 4500000.0, 296411 / 375000.0, 149747 / 4500000.0}, double_unit, 4));
  EXPECT_TRUE(within_units(grid.patch(0, 0).point(0, 0), {7 / 9.0, 5 / 6.0, -7 / 18.0}, double_unit, 2));
}

TEST(BezierExtraction, ASmallerDomainIsTheSameSurfaceThere) {
  Random random(5);
  for (const bool rational : {false, true}) {
    const BSplineSurface s = random_surface(random, 3, 2, {4}, {4, false, true}, rational);
    const Domain all = s.domain();
    const Domain part{all.u_at(0.21), s.knots_u()[6], all.v_at(0.4), all.v_at(0.77)};
    const BSplineSurface cut =
        rational ? value_of(BSplineSurface::rational(3, s.knots_u(), 2, s.knots_v(), s.points(), s.weights(), part))
                 : value_of(BSplineSurface::polynomial(3, s.knots_u(), 2, s.knots_v(), s.points(), part));
    const PatchGrid grid = value_of(to_bezier(cut));
    EXPECT_EQ(grid.domain(), part);
    expect_same_patches(cut, grid, random, 8);
  }
}

TEST(BezierExtraction, TheParameterMapGoesBothWays) {
  Random random(6);
  const BSplineSurface s = random_surface(random, 2, 3, {4, false, true}, {3}, false);
  const PatchGrid grid = value_of(to_bezier(s));
  for (int k = 0; k < 100; ++k) {
    const double u = s.domain().u_at(uniform(random, 0, 1)), v = s.domain().v_at(uniform(random, 0, 1));
    const PatchLocation at = *grid.locate(u, v);
    const Domain d = grid.patch_domain(at.patch);
    EXPECT_TRUE(d.contains(u, v));
    EXPECT_NEAR(d.u_at(at.u), u, 1e-15 * 8);
    EXPECT_NEAR(d.v_at(at.v), v, 1e-15 * 8);
  }
  // At a knot the patch on the right, like the reference.
  const double knot = grid.breaks_u()[1];
  EXPECT_EQ(grid.locate(knot, s.domain().v0)->patch, grid.count_v());
  EXPECT_EQ(grid.locate(knot, s.domain().v0)->u, 0);
}

TEST(BezierExtraction, AControlPointTouchesThePatchesItNames) {
  Random random(7);
  for (const auto& [style_u, style_v] :
       {std::pair{KnotStyle{4}, KnotStyle{3, false, true}}, {KnotStyle{3, true, true}, KnotStyle{4, false}}}) {
    const BSplineSurface s = random_surface(random, 3, 2, style_u, style_v, true);
    const PatchGrid before = value_of(to_bezier(s));
    for (std::size_t i = 0; i < s.count_u(); ++i)
      for (std::size_t j = 0; j < s.count_v(); ++j) {
        std::vector<Vec3> points(s.points().begin(), s.points().end());
        points[i * s.count_v() + j] += Vec3{1, 2, 3};
        const PatchGrid after = value_of(
            to_bezier(value_of(BSplineSurface::rational(3, s.knots_u(), 2, s.knots_v(), points, s.weights()))));
        const PatchRange range = value_of(touched_patches(s, i, j));
        EXPECT_LE((range.a1 - range.a0) * (range.b1 - range.b0), 4u * 3u);
        for (std::size_t a = 0; a < before.count_u(); ++a)
          for (std::size_t b = 0; b < before.count_v(); ++b) {
            const bool named = a >= range.a0 && a < range.a1 && b >= range.b0 && b < range.b1;
            const bool same = std::ranges::equal(before.patch(a, b).points(), after.patch(a, b).points());
            EXPECT_EQ(named, !same) << i << " " << j << " " << a << " " << b;
          }
      }
    EXPECT_EQ(touched_patches(s, s.count_u(), 0).status().code(), StatusCode::invalid_argument);
    EXPECT_EQ(touched_patches(s, 0, s.count_v()).status().code(), StatusCode::invalid_argument);
  }
}

TEST(BezierExtraction, CurvesInPieces) {
  Random random(8);
  for (const int degree : {1, 2, 3, 7})
    for (const KnotStyle& style : extracted_styles)
      for (const bool rational : {false, true}) {
        const Curve curve = random_curve(random, degree, style, rational);
        const BezierPieces pieces = value_of(to_bezier(curve));
        const std::size_t p = static_cast<std::size_t>(degree);
        ASSERT_EQ(pieces.points.size(), (pieces.breaks.size() - 1) * p + 1);
        EXPECT_EQ(pieces.weights.size(), rational ? pieces.points.size() : 0);
        for (std::size_t k = 0; k + 1 < pieces.breaks.size(); ++k) {
          const auto points = std::span(pieces.points).subspan(k * p, p + 1);
          const auto weights = rational ? std::span(pieces.weights).subspan(k * p, p + 1) : std::span<double>{};
          const Curve piece = value_of(Curve::bezier(points, weights, {pieces.breaks[k], pieces.breaks[k + 1]}));
          for (int n = 0; n < 10; ++n) {
            const double t = uniform(random, pieces.breaks[k], pieces.breaks[k + 1]);
            EXPECT_TRUE(within_units(evaluate_jet(piece, t).position, evaluate_jet(curve, t).position, double_unit, 8));
          }
        }
      }
}

TEST(BezierExtraction, AllocatesOnceForAllPatches) {
  Random random(9);
  for (const bool rational : {false, true}) {
    const BSplineSurface few = random_surface(random, 3, 3, {5}, {5}, rational);
    const BSplineSurface many = random_surface(random, 3, 3, {40}, {40}, rational);
    const std::size_t first = allocation_count();
    const PatchGrid few_patches = value_of(to_bezier(few));
    const std::size_t second = allocation_count();
    const PatchGrid many_patches = value_of(to_bezier(many));
    // The list of spans grows by doubling, and each piece of work has rows of its own.
    EXPECT_LE(allocation_count() - second, second - first + 16);
  }
}

TEST(BezierExtraction, AllocatesInProportionToItsOutput) {
  Random random(11);
  for (const int degree : {1, 3, 8})
    for (const bool rational : {false, true}) {
      const BSplineSurface s = random_surface(random, degree, degree, {60}, {60}, rational);
      const std::size_t before = allocated_bytes();
      const PatchGrid grid = value_of(to_bezier(s));
      const std::size_t bytes = allocated_bytes() - before;
      std::size_t output = grid.patches().size_bytes();
      for (const BezierPatch& patch : grid.patches())
        output += patch.points().size_bytes() + patch.weights().size_bytes();
      EXPECT_LE(bytes, 2 * output) << degree << " " << rational;
    }
}

TEST(BezierExtraction, PointsNearTheLargestNumber) {
  Random random(10);
  for (const bool rational : {false, true}) {
    const BSplineSurface s = random_surface(random, 3, 3, {3}, {3}, rational);
    std::vector<Vec3> points(s.points().begin(), s.points().end());
    for (Vec3& p : points) p = {std::copysign(1.7e308, p.x), std::copysign(1.7e308, p.y), 0};
    const Result<PatchGrid> grid =
        to_bezier(rational ? value_of(BSplineSurface::rational(3, s.knots_u(), 3, s.knots_v(), points, s.weights()))
                           : value_of(BSplineSurface::polynomial(3, s.knots_u(), 3, s.knots_v(), points)));
    ASSERT_TRUE(grid.ok() || grid.status().code() == StatusCode::non_finite);
    if (!grid) continue;
    for (const BezierPatch& patch : grid->patches())
      for (const Vec3& p : patch.points()) EXPECT_TRUE(is_finite(p));
  }
}

bool same_bytes(const PatchGrid& a, const PatchGrid& b) {
  return std::ranges::equal(a.patches(), b.patches(), [](const BezierPatch& p, const BezierPatch& q) {
    return std::memcmp(p.points().data(), q.points().data(), p.points().size_bytes()) == 0 &&
           std::ranges::equal(p.weights(), q.weights());
  });
}

/// More strips than one piece of work holds, of a few wide ones and of many narrow ones.
TEST(BezierExtraction, TheSameBytesForAnyNumberOfThreads) {
  Random random(12);
  tbb::task_arena alone(1), crowd(7);
  for (const auto& [spans_u, spans_v] : {std::pair{90, 40}, {3, 3000}, {3000, 1}})
    for (const bool rational : {false, true}) {
      const BSplineSurface s = random_surface(random, 3, 2, {spans_u}, {spans_v}, rational);
      const PatchGrid one = alone.execute([&] { return value_of(to_bezier(s)); });
      const PatchGrid more = crowd.execute([&] { return value_of(to_bezier(s)); });
      EXPECT_TRUE(same_bytes(one, more)) << spans_u << " " << spans_v << " " << rational;
      EXPECT_EQ(one.box().lower, more.box().lower);
      EXPECT_EQ(one.box().upper, more.box().upper);
    }
}

TEST(BezierExtraction, TheGridKnowsItsBox) {
  Random random(13);
  for (const bool rational : {false, true}) {
    const PatchGrid grid = value_of(to_bezier(random_surface(random, 3, 4, {30, false, true}, {50, true}, rational)));
    Box3 box;
    for (const BezierPatch& patch : grid.patches()) box.extend(patch.hull_box());
    EXPECT_EQ(grid.box().lower, box.lower);
    EXPECT_EQ(grid.box().upper, box.upper);
  }
}

/// The piece of work that holds the point does not matter.
TEST(BezierExtraction, RefusesMeansThatAreNotFinite) {
  Random random(14);
  const BSplineSurface s = random_surface(random, 3, 3, {100}, {40}, false);
  for (const std::size_t row : {std::size_t{10}, s.count_u() - 10}) {
    std::vector<Vec3> points(s.points().begin(), s.points().end());
    for (std::size_t i = row; i < row + 4; ++i)
      for (std::size_t j = 10; j < 14; ++j) points[i * s.count_v() + j].y = std::numeric_limits<double>::max();
    const auto grid = to_bezier(value_of(BSplineSurface::polynomial(3, s.knots_u(), 3, s.knots_v(), points)));
    if (!grid) {
      EXPECT_EQ(grid.status().code(), StatusCode::non_finite);
      continue;
    }
    for (const BezierPatch& patch : grid->patches())
      EXPECT_TRUE(std::ranges::all_of(patch.points(), [](const Vec3& p) { return is_finite(p); }));
  }
}

}}  // namespace tessera::test
