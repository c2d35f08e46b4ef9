// Curves, derivatives, subdivision, elevation and reorientation of Bezier patches.

#include "tessera/bezier_operations.h"

#include "support/errors.h"
#include "support/random_patches.h"
#include "support/reference.h"
#include "support/synthetic_sets.h"
#include "support/ulp.h"

namespace tessera::test { namespace {

constexpr double parameters[] = {0, 0.1, 0.5, 0.8125, 1};

/// Polynomial and rational patches over the degrees, small and large, of coordinates up to 1.
std::vector<BezierPatch> samples(Random& random) {
  std::vector<BezierPatch> patches;
  for (const auto& [m, n] : {std::pair{1, 1}, {1, 4}, {2, 2}, {3, 3}, {5, 3}, {7, 9}, {15, 15}}) {
    patches.push_back(random_polynomial(random, m, n));
    patches.push_back(random_rational(random, m, n));
  }
  return patches;
}

/// The curve as a ruled patch of one point a ruling, for the reference.
Vec3 curve_point(const BezierPolygon& curve, double t) {
  BezierPolygon rows = curve;
  rows.points.insert(rows.points.end(), curve.points.begin(), curve.points.end());
  rows.weights.insert(rows.weights.end(), curve.weights.begin(), curve.weights.end());
  const int n = static_cast<int>(curve.points.size()) - 1;
  return reference_position(
      curve.weights.empty() ? polynomial(1, n, rows.points) : rational(1, n, rows.points, rows.weights), 0.5, t);
}

TEST(BezierCurves, IsoparametricLinesLieOnThePatch) {
  Random random(1);
  for (const BezierPatch& patch : samples(random))
    for (const double fixed : parameters) {
      const BezierPolygon along_u = value_of(u_line(patch, fixed)), along_v = value_of(v_line(patch, fixed));
      ASSERT_EQ(along_u.points.size(), static_cast<std::size_t>(patch.degree_u()) + 1);
      ASSERT_EQ(along_v.points.size(), static_cast<std::size_t>(patch.degree_v()) + 1);
      EXPECT_EQ(along_u.weights.size(), patch.is_rational() ? along_u.points.size() : 0);
      for (const double t : parameters) {
        EXPECT_TRUE(within_units(curve_point(along_u, t), reference_position(patch, t, fixed), double_unit, 2));
        EXPECT_TRUE(within_units(curve_point(along_v, t), reference_position(patch, fixed, t), double_unit, 2));
      }
    }
}

TEST(BezierCurves, BordersAreThoseOfTheNet) {
  Random random(2);
  for (const BezierPatch& patch : samples(random)) {
    const auto expect_same = [](const Result<BezierPolygon>& border, const Result<BezierPolygon>& line) {
      EXPECT_EQ(border->points, line->points);
      EXPECT_EQ(border->weights, line->weights);
    };
    expect_same(boundary_curve(patch, Side::u0), v_line(patch, 0));
    expect_same(boundary_curve(patch, Side::u1), v_line(patch, 1));
    expect_same(boundary_curve(patch, Side::v0), u_line(patch, 0));
    expect_same(boundary_curve(patch, Side::v1), u_line(patch, 1));
    for (int j = 0; j <= patch.degree_v(); ++j)
      EXPECT_EQ(boundary_curve(patch, Side::u1)->points[static_cast<std::size_t>(j)], patch.point(patch.degree_u(), j));
  }
}

TEST(BezierDerivatives, ArePatchesOfDifferences) {
  Random random(3);
  for (const auto& [m, n] : {std::pair{1, 1}, {1, 3}, {2, 1}, {3, 3}, {4, 6}, {15, 15}}) {
    const BezierPatch patch = random_polynomial(random, m, n);
    for (const double u : parameters)
      for (const double v : parameters) {
        const RealJet jet = reference_jet(patch, u, v);
        const auto expect = [&, m = m, n = n](int a, int b, const RealVec3& value) {
          const BezierPatch derivative = value_of(derivative_patch(patch, a, b));
          EXPECT_EQ(derivative.degree_u(), std::max(m - a, 1));
          EXPECT_EQ(derivative.degree_v(), std::max(n - b, 1));
          const double size = std::pow(2.0 * m, a) * std::pow(2.0 * n, b);
          EXPECT_TRUE(within_units(reference_position(derivative, u, v), value.rounded(), double_unit * size, 2))
              << m << " " << n << " order " << a << b;
        };
        expect(0, 0, jet.position);
        expect(1, 0, jet.du);
        expect(0, 1, jet.dv);
        expect(2, 0, jet.duu);
        expect(1, 1, jet.duv);
        expect(0, 2, jet.dvv);
      }
  }
}

TEST(BezierDerivatives, CornersOfABicubic) {
  Random random(4);
  const BezierPatch patch = random_polynomial(random, 3, 3);
  const auto v = [&](int i, int j) { return patch.point(i, j); };
  EXPECT_EQ(value_of(derivative_patch(patch, 1, 0)).point(0, 0), 3 * (v(1, 0) - v(0, 0)));
  EXPECT_TRUE(within_units(value_of(derivative_patch(patch, 1, 1)).point(0, 0),
                           9 * (v(1, 1) - v(1, 0) - v(0, 1) + v(0, 0)), 36 * double_unit, 1));
}

TEST(BezierDerivatives, AboveTheDegreeAreZero) {
  Random random(5);
  const BezierPatch patch = random_polynomial(random, 2, 3);
  for (const auto& [a, b] : {std::pair{3, 0}, {0, 4}, {5, 1}, {3, 9}}) {
    const BezierPatch zero = value_of(derivative_patch(patch, a, b));
    for (const Vec3& p : zero.points()) EXPECT_EQ(p, Vec3{});
  }
  // The highest that is not: constant.
  const BezierPatch last = value_of(derivative_patch(patch, 2, 3));
  for (const Vec3& p : last.points()) EXPECT_EQ(p, last.point(0, 0));
  EXPECT_GT(max_abs(last.point(0, 0)), 0);
}

TEST(BezierTwists, NoneOneAndFourOnABorder) {
  // A translational net has none: V_ij = a_i + b_j, in small whole numbers so that nothing rounds.
  std::vector<Vec3> points;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) points.push_back({i * 3.0, j * 5.0, i * i + 2.0 * j * j * j});
  const auto twists = [](const std::vector<Vec3>& net) { return corner_twists(polynomial(3, 3, net)); };
  for (const Vec3& twist : twists(points)) EXPECT_EQ(twist, Vec3{});

  const std::vector<Vec3> border = points;
  const std::size_t inner[] = {5, 6, 9, 10};  // beside (0,0), (0,1), (1,0), (1,1)
  const double signs[] = {9, -9, -9, 9};
  for (std::size_t corner = 0; corner < 4; ++corner) {
    std::vector<Vec3> one = border;
    one[inner[corner]] += {0, 0, 2};
    for (std::size_t k = 0; k < 4; ++k)
      EXPECT_EQ(twists(one)[k], k == corner ? (Vec3{0, 0, 2 * signs[k]}) : Vec3{}) << corner << " " << k;
  }
  std::vector<Vec3> four = border;
  for (std::size_t k = 0; k < 4; ++k) four[inner[k]] += {1, 0, -1};
  for (std::size_t k = 0; k < 4; ++k) EXPECT_EQ(twists(four)[k], (Vec3{signs[k], 0, -signs[k]}));
}

TEST(BezierTwists, OfRationalPatchesByTheQuotientRule) {
  Random random(6);
  const BezierPatch patch = random_rational(random, 3, 2);
  const auto twists = corner_twists(patch);
  for (std::size_t k = 0; k < 4; ++k)
    EXPECT_LT(max_abs(twists[k] - reference_jet(patch, k / 2, k % 2).duv.rounded()), 1e-12);
}

/// r of the part at local (s,t) is r of the patch.
void expect_part(const BezierPatch& part, const BezierPatch& patch, const Domain& rectangle) {
  EXPECT_EQ(part.degree_u(), patch.degree_u());
  EXPECT_EQ(part.degree_v(), patch.degree_v());
  EXPECT_EQ(part.is_rational(), patch.is_rational());
  const auto between = [](Real from, Real to, Real t) {
    return from + t * (to - from);
  };  // a rounded one is another point
  for (const double s : parameters)
    for (const double t : parameters) {
      const Real u = between(rectangle.u0, rectangle.u1, s), v = between(rectangle.v0, rectangle.v1, t);
      EXPECT_TRUE(within_units(reference_position(part, s, t), reference_position(patch, u, v), double_unit, 2));
    }
  const Box3 hull = patch.hull_box(), box = part.hull_box();
  EXPECT_LE(box.upper.x, hull.upper.x + double_unit);
  EXPECT_GE(box.lower.z, hull.lower.z - double_unit);
}

TEST(BezierSubdivision, HalvesAreThePatch) {
  Random random(7);
  for (const BezierPatch& patch : samples(random))
    for (const double t : {0.03125, 0.4, 0.99}) {
      const auto [left, right] = value_of(split_u(patch, t));
      expect_part(left, patch, {0, t, 0, 1});
      expect_part(right, patch, {t, 1, 0, 1});
      const auto [low, high] = value_of(split_v(patch, t));
      expect_part(low, patch, {0, 1, 0, t});
      expect_part(high, patch, {0, 1, t, 1});
      EXPECT_EQ(value_of(boundary_curve(left, Side::u1)).points, value_of(boundary_curve(right, Side::u0)).points);
      EXPECT_EQ(value_of(boundary_curve(left, Side::u1)).weights, value_of(boundary_curve(right, Side::u0)).weights);
      EXPECT_EQ(value_of(boundary_curve(low, Side::v1)).points, value_of(boundary_curve(high, Side::v0)).points);
    }
}

TEST(BezierSubdivision, AtTheEndsOnePartIsTheWhole) {
  Random random(8);
  for (const BezierPatch& patch : samples(random)) {
    const auto [left, right] = value_of(split_u(patch, 0));
    EXPECT_TRUE(std::equal(right.points().begin(), right.points().end(), patch.points().begin()));
    EXPECT_TRUE(left.collapsed_sides().has(Side::v0));
    const auto [low, high] = value_of(split_v(patch, 1));
    EXPECT_TRUE(std::equal(low.points().begin(), low.points().end(), patch.points().begin()));
    EXPECT_TRUE(high.collapsed_sides().has(Side::u1));
  }
}

TEST(BezierSubdivision, SubPatches) {
  Random random(9);
  for (const BezierPatch& patch : samples(random)) {
    for (const Domain& d : {Domain{0.25, 0.5, 0.1, 0.9}, {0, 1, 0.3, 0.31}, {0.9, 1, 0, 1e-3}})
      expect_part(value_of(sub_patch(patch, d)), patch, d);
    const BezierPatch whole = value_of(sub_patch(patch, {0, 1, 0, 1}));
    EXPECT_TRUE(std::equal(whole.points().begin(), whole.points().end(), patch.points().begin()));
    // Two that meet at a line, and the two halves of a half.
    const BezierPatch a = value_of(sub_patch(patch, {0.1, 0.3, 0.2, 0.7})),
                      b = value_of(sub_patch(patch, {0.3, 0.8, 0.2, 0.7}));
    EXPECT_EQ(value_of(boundary_curve(a, Side::u1)).points, value_of(boundary_curve(b, Side::u0)).points);
    EXPECT_EQ(value_of(boundary_curve(a, Side::u1)).weights, value_of(boundary_curve(b, Side::u0)).weights);
  }
}

TEST(BezierSubdivision, PolesStayPoles) {
  Random random(10);
  for (const bool with_weights : {false, true}) {
    std::vector<Vec3> points = random_points(random, 4, 5);
    for (std::size_t j = 0; j <= 5; ++j) points[j] = {0.1, 0.7, -0.3};
    const BezierPatch patch =
        rational(4, 5, points, with_weights ? random_weights(random, 4, 5, 0.3, 3) : std::vector<double>(30, 1));
    EXPECT_TRUE(value_of(split_v(patch, 0.3)).first.collapsed_sides().has(Side::u0));
    EXPECT_TRUE(value_of(split_u(patch, 0.7)).first.collapsed_sides().has(Side::u0));
    EXPECT_TRUE(value_of(sub_patch(patch, {0, 0.3, 0.1, 0.6})).collapsed_sides().has(Side::u0));
    EXPECT_TRUE(value_of(elevate_degree(patch, 9, 11)).collapsed_sides().has(Side::u0));
  }
}

TEST(BezierSubdivision, PartsOfARationalPatchStayRational) {
  // The part over [0,0] has the equal weights of the row u = 0, and neighbours that are rational.
  std::vector<double> weights(6, 1);
  weights[4] = weights[5] = 3;
  Random random(16);
  const BezierPatch patch = rational(2, 1, random_points(random, 2, 1), weights);
  const BezierPatch edge = value_of(split_u(patch, 0)).first;
  EXPECT_TRUE(edge.is_rational());
  for (const double weight : edge.weights()) EXPECT_EQ(weight, 1);
}

TEST(BezierElevation, KeepsThePatchAtAnyHigherDegree) {
  Random random(11);
  for (const BezierPatch& patch : samples(random))
    for (int by = 0; patch.degree_u() + by <= max_degree; by += 3) {
      const int m = patch.degree_u() + by, n = std::max(patch.degree_v(), max_degree - by);
      const BezierPatch high = value_of(elevate_degree(patch, m, n));
      EXPECT_EQ(high.degree_u(), m);
      EXPECT_EQ(high.degree_v(), n);
      EXPECT_EQ(high.is_rational(), patch.is_rational());
      for (const double u : parameters)
        for (const double v : parameters)
          EXPECT_TRUE(within_units(reference_position(high, u, v), reference_position(patch, u, v), double_unit, 2));
    }
}

TEST(BezierElevation, ByOneIsTheFormulaOfTheBooks) {
  Random random(12);
  const BezierPatch patch = random_polynomial(random, 4, 2);
  const BezierPatch high = value_of(elevate_degree(patch, 5, 2));
  for (int i = 0; i <= 5; ++i)
    for (int j = 0; j <= 2; ++j) {
      const double a = i / 5.0;
      const Vec3 expected =
          (i > 0 ? a * patch.point(i - 1, j) : Vec3{}) + (i < 5 ? (1 - a) * patch.point(i, j) : Vec3{});
      EXPECT_TRUE(within_units(high.point(i, j), expected, double_unit, 2));
    }
}

TEST(BezierReorientation, IsExact) {
  Random random(13);
  for (const BezierPatch& patch : samples(random)) {
    const auto same = [](const BezierPatch& a, const BezierPatch& b) {
      return std::equal(a.points().begin(), a.points().end(), b.points().begin(), b.points().end()) &&
             std::equal(a.weights().begin(), a.weights().end(), b.weights().begin(), b.weights().end());
    };
    const BezierPatch other = value_of(tessera::transpose(patch)), back_u = value_of(reverse_u(patch)),
                      back_v = value_of(reverse_v(patch));
    for (int i = 0; i <= patch.degree_u(); ++i)
      for (int j = 0; j <= patch.degree_v(); ++j) {
        EXPECT_EQ(other.point(j, i), patch.point(i, j));
        EXPECT_EQ(other.weight(j, i), patch.weight(i, j));
        EXPECT_EQ(back_u.point(patch.degree_u() - i, j), patch.point(i, j));
        EXPECT_EQ(back_v.point(i, patch.degree_v() - j), patch.point(i, j));
        EXPECT_EQ(back_v.weight(i, patch.degree_v() - j), patch.weight(i, j));
      }
    EXPECT_TRUE(same(value_of(tessera::transpose(other)), patch));
    EXPECT_TRUE(same(value_of(reverse_u(back_u)), patch));
    EXPECT_TRUE(same(value_of(reverse_v(back_v)), patch));
  }
}

TEST(BezierOperations, WorkAtAnySize) {
  Random random(14);
  for (const double size : {1e-300, 1e300})
    for (const double weight : {1e-200, 1e200}) {
      const BezierPatch unit = random_rational(random, 3, 3);
      std::vector<Vec3> points;
      std::vector<double> weights;
      for (std::size_t k = 0; k < 16; ++k) {
        points.push_back(size * unit.points()[k]);
        weights.push_back(weight * unit.weights()[k]);
      }
      const BezierPatch half = value_of(split_u(rational(3, 3, points, weights), 0.3)).first,
                        expected = value_of(split_u(unit, 0.3)).first;
      for (std::size_t k = 0; k < 16; ++k) {
        EXPECT_TRUE(within_units((1 / size) * half.points()[k], expected.points()[k], double_unit, 2));
        EXPECT_NEAR(half.weights()[k] / weight, expected.weights()[k], 4 * double_unit);
      }
    }
}

TEST(BezierOperations, RefuseBadArguments) {
  Random random(15);
  const BezierPatch patch = random_polynomial(random, 3, 2), fraction = random_rational(random, 3, 2);
  for (const double bad : {-0.001, 1.001, infinity, not_a_number}) {
    const StatusCode code = std::isfinite(bad) ? StatusCode::invalid_argument : StatusCode::non_finite;
    expect_refused(u_line(patch, bad), code, -1, "parameter v = ");
    expect_refused(v_line(patch, bad), code, -1, "parameter u = ");
    expect_refused(split_u(patch, bad), code, -1, "is not in [0, 1]");
    expect_refused(split_v(patch, bad), code, -1, "is not in [0, 1]");
    expect_refused(sub_patch(patch, {bad, 0.5, 0, 1}), code, -1, "the range of u, [");
    expect_refused(sub_patch(patch, {0, 1, 0.5, bad}), code, -1, "the range of v, [0.5, ");
  }
  expect_refused(sub_patch(patch, {0.5, 0.5, 0, 1}), StatusCode::invalid_argument, -1, "[0.5, 0.5]");
  expect_refused(sub_patch(patch, {0, 1, 0.7, 0.5}), StatusCode::invalid_argument, -1, "[0.7, 0.5]");
  expect_refused(boundary_curve(patch, static_cast<Side>(4)), StatusCode::invalid_argument, -1, "u0, u1, v0 or v1");
  expect_refused(derivative_patch(patch, -1, 0), StatusCode::invalid_argument, -1, "(-1, 0), it must not be negative");
  expect_refused(derivative_patch(fraction, 1, 0), StatusCode::unsupported, -1, "rational");
  expect_refused(elevate_degree(patch, 2, 2), StatusCode::unsupported_degree, -1,
                 "degree u cannot be elevated from 3 to 2");
  expect_refused(elevate_degree(patch, 3, 16), StatusCode::unsupported_degree, -1,
                 "degree v cannot be elevated from 2 to 16");
  const BezierPatch huge = polynomial(1, 1, {{1e308, 0, 0}, {}, {-1e308, 0, 0}, {}});
  expect_refused(derivative_patch(huge, 1, 0), StatusCode::non_finite, 0, "control point [0][0] is (-inf");
}

}}  // namespace tessera::test
