// Bicubic Hermite patches: the figures of the lectures, their forms, and errors.

#include "support/errors.h"
#include "support/random_hermite.h"
#include "support/ulp.h"

namespace tessera::test { namespace {

using Corners = HermitePatch::OpenCorners;

constexpr Vec3 east{1, 0, 0}, north{0, 1, 0};

/// (0,0,0), (0,1,0), (1,0,0), (1,1,0) with r_u = east, r_v = north.
Corners unit_square() {
  return {{{{0, 0, 0}, east, north}, {{0, 1, 0}, east, north}, {{1, 0, 0}, east, north}, {{1, 1, 0}, east, north}}};
}

double h0(double t) { return 1 - 3 * t * t + 2 * t * t * t; }
double h1(double t) { return t - 2 * t * t + t * t * t; }

TEST(HermiteFigures, Ferguson) {
  Corners corners{
      {{{0, 0, 1}, east, {0, 1, -1}}, {{0, 1, 0}, east, north}, {{1, 0, 1}, east, north}, {{1, 1, 0}, east, north}}};
  const HermitePatch patch = value_of(HermitePatch::ferguson(corners));
  EXPECT_EQ(evaluate_jet(patch, 0.25, 0.75).position, (Vec3{0.25, 0.75, 0.11669921875}));
  for (int i = 0; i <= 16; ++i)
    for (int j = 0; j <= 16; ++j) {
      const double u = i / 16.0, v = j / 16.0;
      EXPECT_TRUE(within_units(evaluate_jet(patch, u, v).position, {u, v, h0(v) - h0(u) * h1(v)}, double_unit, 2));
    }
}

TEST(HermiteFigures, SixteenVectors) {
  const double twist = 10;
  HermitePatch::Corners corners;
  for (std::size_t k = 0; k < 4; ++k) corners[k] = {unit_square()[k].position, east, north, {}};
  corners[0].duv = {0, 0, twist};
  const HermitePatch patch = value_of(HermitePatch::from_corners(corners));
  EXPECT_EQ(evaluate_jet(patch, 0.25, 0.75).position, (Vec3{0.25, 0.75, 0.06591796875}));
  for (int i = 0; i <= 16; ++i)
    for (int j = 0; j <= 16; ++j) {
      const double u = i / 16.0, v = j / 16.0;
      EXPECT_TRUE(within_units(evaluate_jet(patch, u, v).position, {u, v, twist * h1(u) * h1(v)}, double_unit, 4));
    }
}

TEST(HermiteFigures, TwelveVectorsOfASquareAreThePlane) {
  for (const HermitePatch& patch :
       {value_of(HermitePatch::ferguson(unit_square())), value_of(HermitePatch::adini(unit_square()))})
    for (int i = 0; i <= 16; ++i)
      for (int j = 0; j <= 16; ++j)
        EXPECT_EQ(evaluate_jet(patch, i / 16.0, j / 16.0).position, (Vec3{i / 16.0, j / 16.0, 0}));
}

TEST(HermitePatch, HasTheGivenVectorsAtItsCorners) {
  Random random(1);
  for (const Domain& d : {Domain{}, Domain{-1, 3, 2, 2.5}}) {
    HermitePatch::Corners corners;
    for (HermiteNode& corner : corners) corner = random_node(random, 0, 0);
    const HermitePatch patch = value_of(HermitePatch::from_corners(corners, d));
    for (int a = 0; a < 2; ++a)
      for (int b = 0; b < 2; ++b) {
        const HermiteNode& expected = corners[static_cast<std::size_t>(2 * a + b)];
        EXPECT_EQ(patch.corner(a, b), expected);
        const SurfaceJet jet = evaluate_jet(patch, a == 0 ? d.u0 : d.u1, b == 0 ? d.v0 : d.v1);
        EXPECT_EQ(jet.position, expected.position);
        EXPECT_TRUE(within_units(jet.du, expected.du, double_unit, 2));
        EXPECT_TRUE(within_units(jet.dv, expected.dv, double_unit, 2));
        EXPECT_TRUE(within_units(jet.duv, expected.duv, double_unit, 2));
      }
  }
}

TEST(HermitePatch, DerivativesAreThoseOfThePositions) {
  Random random(2);
  const HermitePatch patch = random_hermite(random, {-1, 3, 2, 2.5});
  const double u = 0.7, v = 2.2, step = 1e-4;
  const auto at = [&](double du, double dv) { return evaluate_jet(patch, u + step * du, v + step * dv); };
  const SurfaceJet jet = at(0, 0);
  const auto slope = [&](const Vec3& high, const Vec3& low) { return (0.5 / step) * (high - low); };
  EXPECT_LT(max_abs(jet.du - slope(at(1, 0).position, at(-1, 0).position)), 1e-6);
  EXPECT_LT(max_abs(jet.dv - slope(at(0, 1).position, at(0, -1).position)), 1e-6);
  EXPECT_LT(max_abs(jet.duu - slope(at(1, 0).du, at(-1, 0).du)), 1e-6);
  EXPECT_LT(max_abs(jet.duv - slope(at(0, 1).du, at(0, -1).du)), 1e-6);
  EXPECT_LT(max_abs(jet.dvv - slope(at(0, 1).dv, at(0, -1).dv)), 1e-5);
}

TEST(HermitePatch, BothOrdersAreTheSamePatch) {
  Random random(3);
  const HermitePatch patch = random_hermite(random);
  const HermitePatch::Grid by_end = patch.geometry(), by_kind = patch.geometry(HermiteOrder::by_kind);
  EXPECT_EQ(by_kind[0], by_end[0]);    // r(0,0)
  EXPECT_EQ(by_kind[1], by_end[3]);    // r(0,1)
  EXPECT_EQ(by_kind[4], by_end[12]);   // r(1,0)
  EXPECT_EQ(by_kind[2], by_end[1]);    // r_v(0,0)
  EXPECT_EQ(by_kind[15], by_end[10]);  // r_uv(1,1)
  EXPECT_EQ(by_kind[9], by_end[7]);    // r_u(0,1)
  const HermitePatch other = value_of(HermitePatch::make(by_kind, {}, HermiteOrder::by_kind));
  EXPECT_EQ(other.geometry(), by_end);
  EXPECT_EQ(other.geometry(HermiteOrder::by_kind), by_kind);
}

TEST(HermitePatch, AlgebraicFormThereAndBack) {
  Random random(4);
  for (const Domain& d : {Domain{}, Domain{-1, 3, 2, 2.5}}) {
    const HermitePatch patch = random_hermite(random, d);
    const HermitePatch::Grid a = patch.algebraic_form();
    for (const double s : {0.0, 0.3, 1.0})
      for (const double t : {0.0, 0.6, 1.0}) {
        Vec3 sum;
        for (int i = 3; i >= 0; --i) {
          Vec3 row;
          for (int j = 3; j >= 0; --j) row = t * row + a[static_cast<std::size_t>(4 * i + j)];
          sum = s * sum + row;
        }
        EXPECT_LT(max_abs(sum - evaluate_jet(patch, d.u_at(s), d.v_at(t)).position), 1e-13);
      }
    const HermitePatch back = value_of(HermitePatch::from_algebraic(a, d));
    for (std::size_t k = 0; k < 16; ++k) EXPECT_LT(max_abs(back.geometry()[k] - patch.geometry()[k]), 1e-13);
  }
  // Whole numbers stay exact.
  HermitePatch::Grid whole;
  for (std::size_t k = 0; k < 16; ++k) whole[k] = {static_cast<double>(k), 3.0 - static_cast<double>(k * k), 1};
  EXPECT_EQ(value_of(HermitePatch::from_algebraic(whole)).algebraic_form(), whole);
}

TEST(HermitePatch, ThroughSixteenPointsThereAndBack) {
  Random random(5);
  for (const Domain& d : {Domain{}, Domain{-1, 3, 2, 2.5}}) {
    const HermitePatch patch = random_hermite(random, d);
    const std::array<double, 4> u{d.u_at(0), d.u_at(0.3), d.u_at(0.7), d.u_at(1)};
    const std::array<double, 4> v{d.v_at(0.9), d.v_at(0.1), d.v_at(-0.2), d.v_at(0.5)};  // any order, outside too
    const HermitePatch::Grid points = patch.points_at(u, v);
    const HermitePatch back = value_of(HermitePatch::through_points(points, u, v, d));
    for (std::size_t k = 0; k < 16; ++k) EXPECT_LT(max_abs(back.geometry()[k] - patch.geometry()[k]), 1e-12);
    for (std::size_t k = 0; k < 16; ++k) EXPECT_LT(max_abs(back.points_at(u, v)[k] - points[k]), 1e-13);
  }
}

TEST(HermitePatch, AdiniTwistsReproduceBilinearlyBlendedTwists) {
  // The bilinear Coons patch of these borders is (u, v, u^2 v + 3 u v^2 + u^3 - v^3): its twist 2u + 6v is Adini's.
  const auto corner = [](double u, double v) {
    return CornerTangents{{u, v, u * u * v + 3 * u * v * v + u * u * u - v * v * v},
                          {1, 0, 2 * u * v + 3 * v * v + 3 * u * u},
                          {0, 1, u * u + 6 * u * v - 3 * v * v}};
  };
  const Domain d{-1, 3, 2, 2.5};
  const HermitePatch patch =
      value_of(HermitePatch::adini({corner(-1, 2), corner(-1, 2.5), corner(3, 2), corner(3, 2.5)}, d));
  // Adini's own formula, of the definition in section 7.
  const double du = 4, dv = 0.5;
  const auto p = [&](int a, int b) { return patch.corner(a, b); };
  for (int a = 0; a < 2; ++a)
    for (int b = 0; b < 2; ++b) {
      const Vec3 expected =
          (1 / dv) * (p(a, 1).du - p(a, 0).du) + (1 / du) * (p(1, b).dv - p(0, b).dv) -
          (1 / (du * dv)) * (p(0, 0).position - p(1, 0).position - p(0, 1).position + p(1, 1).position);
      EXPECT_LT(max_abs(patch.corner(a, b).duv - expected), 1e-12);
      EXPECT_EQ(patch.corner(a, b).duv.x, 0);
    }
  // A surface that is bilinear plus functions of u and of v alone has exactly these twists.
  const auto exact = [](double u, double v) {
    return CornerTangents{{u, v, 5 * u * v + u * u * u - v * v}, {1, 0, 5 * v + 3 * u * u}, {0, 1, 5 * u - 2 * v}};
  };
  const HermitePatch same = value_of(HermitePatch::adini({exact(0, 0), exact(0, 1), exact(1, 0), exact(1, 1)}));
  for (int a = 0; a < 2; ++a)
    for (int b = 0; b < 2; ++b) EXPECT_EQ(same.corner(a, b).duv, (Vec3{0, 0, 5}));
}

TEST(HermitePatch, ReparametrizedIsTheSameSurface) {
  Random random(6);
  const Domain from{-1, 3, 2, 2.5}, to{10, 12, -3, 5};
  const HermitePatch patch = random_hermite(random, from);
  const HermitePatch other = value_of(patch.reparametrize(to));
  EXPECT_EQ(other.domain(), to);
  EXPECT_EQ(other.corner(1, 0).du, 2 * patch.corner(1, 0).du);
  EXPECT_EQ(other.corner(1, 0).dv, 0.0625 * patch.corner(1, 0).dv);
  EXPECT_EQ(other.corner(1, 0).duv, 0.125 * patch.corner(1, 0).duv);
  for (const double s : {0.0, 0.4, 1.0})
    for (const double t : {0.0, 0.7, 1.0})
      EXPECT_LT(max_abs(evaluate_jet(other, to.u_at(s), to.v_at(t)).position -
                        evaluate_jet(patch, from.u_at(s), from.v_at(t)).position),
                1e-14);
}

TEST(HermitePatch, IsAffinelyInvariant) {
  // Only the linear part applies to tangents and twists.
  Random random(7);
  const HermitePatch patch = random_hermite(random);
  const auto linear = [](const Vec3& p) { return Vec3{2 * p.y, p.z - p.x, 3 * p.x}; };
  HermitePatch::Grid moved = patch.geometry();
  for (std::size_t k = 0; k < 16; ++k) moved[k] = linear(moved[k]);
  for (const std::size_t corner : {0u, 3u, 12u, 15u}) moved[corner] += {1, -5, 2};
  const HermitePatch image = value_of(HermitePatch::make(moved));
  for (const double u : {0.1, 0.8})
    for (const double v : {0.3, 1.0})
      EXPECT_LT(
          max_abs(evaluate_jet(image, u, v).position - (linear(evaluate_jet(patch, u, v).position) + Vec3{1, -5, 2})),
          1e-14);
}

TEST(HermitePatch, RefusesWhatIsNotAPatch) {
  Random random(8);
  HermitePatch::Grid grid = random_grid(random);
  expect_refused(HermitePatch::make(std::vector<Vec3>(12)), StatusCode::count_mismatch, -1,
                 "a bicubic patch has 4 x 4 vectors, found 12");
  expect_refused(HermitePatch::from_algebraic(std::vector<Vec3>(17)), StatusCode::count_mismatch, -1,
                 "4 x 4 coefficients");
  expect_refused(HermitePatch::make(grid, {0, 0, 0, 1}), StatusCode::invalid_argument, -1,
                 "the domain along u, [0, 0]");
  expect_refused(HermitePatch::from_algebraic(grid, {0, 1, 1, 0}), StatusCode::invalid_argument, -1,
                 "the domain along v");
  expect_refused(HermitePatch::adini(unit_square(), {0, not_a_number, 0, 1}), StatusCode::non_finite, -1, "along u");
  expect_refused(random_hermite(random).reparametrize({0, 0, 0, 1}), StatusCode::invalid_argument, -1, "along u");
  Corners corners = unit_square();
  corners[1].dv.z = infinity;
  expect_refused(HermitePatch::ferguson(corners), StatusCode::non_finite, 2, "geometry element [0][2] is (0, 1, inf)");
  grid[6].x = not_a_number;
  expect_refused(HermitePatch::make(grid), StatusCode::non_finite, 6, "geometry element [1][2] is (nan");
  expect_refused(HermitePatch::from_algebraic(grid), StatusCode::non_finite, 6, "coefficient [1][2] is (nan");
}

TEST(HermitePatch, RefusesSingularSystemsOfPoints) {
  Random random(9);
  const HermitePatch::Grid points = random_grid(random);
  const std::vector<double> good{0, 0.25, 0.75, 1}, twice{0, 0.5, 1, 0.5};
  expect_refused(HermitePatch::through_points(points, twice, good), StatusCode::invalid_argument, 3,
                 "the system of 16 points is singular: parameters u[1] = 0.5 and u[3] = 0.5 are equal");
  expect_refused(HermitePatch::through_points(points, good, twice), StatusCode::invalid_argument, 3,
                 "parameters v[1] = 0.5");
  expect_refused(HermitePatch::through_points(points, std::vector<double>{0, 1, 2}, good), StatusCode::count_mismatch,
                 -1, "four parameters u, found 3");
  expect_refused(HermitePatch::through_points(std::vector<Vec3>(15), good, good), StatusCode::count_mismatch, -1,
                 "4 x 4 points");
  expect_refused(HermitePatch::through_points(points, good, std::vector<double>{0, 1, not_a_number, 2}),
                 StatusCode::non_finite, 2, "parameter v[2] is nan");
  expect_refused(HermitePatch::through_points(points, std::vector<double>{0, 1e-200, 2e-200, 3e-200}, good),
                 StatusCode::non_finite, -1, "the parameters of the 16 points are too close");
}

TEST(HermitePatch, FromBezierOfLowDegreesOnly) {
  Random random(10);
  expect_refused(HermitePatch::from_bezier(random_rational(random, 3, 3)), StatusCode::unsupported, -1, "rational");
  expect_refused(HermitePatch::from_bezier(random_polynomial(random, 4, 2)), StatusCode::unsupported_degree, -1,
                 "a patch of degree (4, 2) has no bicubic Hermite form");
  for (int m = 1; m <= 3; ++m)
    for (int n = 1; n <= 3; ++n) {
      const BezierPatch bezier = random_polynomial(random, m, n);
      const Domain d{-1, 3, 2, 2.5};
      const HermitePatch patch = value_of(HermitePatch::from_bezier(bezier, d));
      for (const double s : {0.0, 0.3, 1.0})
        for (const double t : {0.2, 0.9})
          EXPECT_LT(max_abs(evaluate_jet(patch, d.u_at(s), d.v_at(t)).position - de_casteljau(bezier, s, t)), 1e-14);
    }
}

}}  // namespace tessera::test
