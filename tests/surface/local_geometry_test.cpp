// Compares local geometry with closed forms, under changes of parameters and of scale, and at points that have none.

#include "tessera/local_geometry.h"

#include <limits>

#include "support/quadrics.h"
#include "support/ulp.h"

namespace tessera::test { namespace {

constexpr double local_geometry_nan = std::numeric_limits<double>::quiet_NaN();

SurfaceJet torus(double big, double small, double u, double v) {
  const double cu = std::cos(u), su = std::sin(u), cv = std::cos(v), sv = std::sin(v), r = big + small * cv;
  return {{r * cu, r * su, small * sv},
          {-r * su, r * cu, 0},
          {-small * sv * cu, -small * sv * su, small * cv},
          {-r * cu, -r * su, 0},
          {small * sv * su, -small * sv * cu, 0},
          {-small * cv * cu, -small * cv * su, -small * sv}};
}
/// The graph z = a x^2 + b x y + c y^2 at its top.
SurfaceJet graph(double a, double b, double c) {
  return {{}, {1, 0, 0}, {0, 1, 0}, {0, 0, 2 * a}, {0, 0, b}, {0, 0, 2 * c}};
}
/// Changes the parameters of a surface: u = a s + b t, v = c s + d t.
SurfaceJet reparametrised(const SurfaceJet& j, double a, double b, double c, double d) {
  return {j.position,
          a * j.du + c * j.dv,
          b * j.du + d * j.dv,
          a * a * j.duu + 2 * a * c * j.duv + c * c * j.dvv,
          a * b * j.duu + (a * d + b * c) * j.duv + c * d * j.dvv,
          b * b * j.duu + 2 * b * d * j.duv + d * d * j.dvv};
}

void expect_consistent(const LocalGeometry& g, const SurfaceJet& jet) {
  ASSERT_TRUE(g.defined);
  EXPECT_GE(g.first.curvature, g.second.curvature);
  const double size = std::abs(g.first.curvature) + std::abs(g.second.curvature);
  EXPECT_NEAR(g.gaussian, g.first.curvature * g.second.curvature, 1e-13 * size * size);
  EXPECT_NEAR(g.mean, 0.5 * (g.first.curvature + g.second.curvature), 1e-14 * size);
  EXPECT_LT(max_abs(cross(g.first.direction, g.second.direction) - g.normal.direction), 1e-14);
  for (const PrincipalDirection& d : {g.first, g.second}) {
    const auto [du, dv] = d.parameters;
    EXPECT_LT(max_abs(du * jet.du + dv * jet.dv - d.direction), 1e-13);
    // The normal curvature along a principal direction is its curvature.
    EXPECT_NEAR(g.l * du * du + 2 * g.m * du * dv + g.n * dv * dv, d.curvature, 1e-12 * (size + 1e-300));
  }
}

TEST(LocalGeometry, Torus) {
  for (int i = 0; i < 24; ++i)
    for (int j = 0; j < 24; ++j) {
      const double u = 0.26 * i, v = 0.26 * j;
      const SurfaceJet jet = torus(3, 1, u, v);
      const LocalGeometry g = local_geometry(jet);
      expect_consistent(g, jet);
      // r_u x r_v points outwards: both circles bend away.
      const double ring = -std::cos(v) / (3 + std::cos(v));
      EXPECT_NEAR(g.second.curvature, -1, 1e-14);
      EXPECT_NEAR(g.first.curvature, ring, 1e-14);
      EXPECT_NEAR(g.gaussian, -ring, 1e-14);
      EXPECT_NEAR(std::abs(dot(g.first.direction, normalized(jet.du))), 1, 1e-14);
      EXPECT_FALSE(g.umbilic);
    }
}

TEST(LocalGeometry, SphereIsUmbilicEverywhere) {
  for (const double radius : {1e-100, 1e-6, 2.0, 1e6, 1e100}) {
    const QuadricPiece ball = piece(quadric({.a = 1, .b = 1, .c = 1, .k = -1}), {0, 6, -1.5, 1.5});
    for (double v = -1.5; v <= 1.5; v += 0.25) {
      SurfaceJet jet = evaluate_jet(ball, 1 + v, v);
      jet = {radius * jet.position, radius * jet.du,  radius * jet.dv,
             radius * jet.duu,      radius * jet.duv, radius * jet.dvv};
      const LocalGeometry g = local_geometry(jet);
      ASSERT_TRUE(g.defined);
      EXPECT_TRUE(g.umbilic);
      EXPECT_NEAR(g.mean * radius, -1, 1e-14);
      EXPECT_NEAR(g.gaussian * radius * radius, 1, 1e-13);
      EXPECT_LT(length(g.normal.direction - normalized(jet.position)), 1e-14);
    }
  }
}

TEST(LocalGeometry, CylinderSaddleParaboloid) {
  const QuadricPiece cylinder = piece(quadric({.a = 0.25, .b = 0.25, .k = -1}), {0, 6, 0, 1});
  const LocalGeometry c = local_geometry(evaluate_jet(cylinder, 1, 0.5));
  EXPECT_NEAR(c.second.curvature, -0.5, 1e-15);
  EXPECT_NEAR(c.first.curvature, 0, 1e-15);
  EXPECT_NEAR(c.gaussian, 0, 1e-15);
  EXPECT_LT(max_abs(cross(c.first.direction, Vec3{0, 0, 1})), 1e-15);

  const LocalGeometry saddle = local_geometry(graph(0, 2, 0));  // z = 2 x y: +-2 along the diagonals
  EXPECT_NEAR(saddle.first.curvature, 2, 1e-15);
  EXPECT_NEAR(saddle.second.curvature, -2, 1e-15);
  EXPECT_EQ(saddle.mean, 0);
  EXPECT_LT(max_abs(saddle.first.direction - normalized({1, 1, 0})), 1e-15);

  // z = x^2 + y^2 at radius r: 2 / (1 + 4 r^2)^(3/2) along the meridian, 2 / sqrt(1 + 4 r^2) across.
  const QuadricPiece bowl = piece(quadric({.a = 1, .b = 1, .j = -0.5}), {0, 6, 0, 3});
  for (const double r : {0.25, 1.0, 2.5}) {
    const LocalGeometry g = local_geometry(evaluate_jet(bowl, 2, r));
    const double s = std::sqrt(1 + 4 * r * r);
    // u x v of the polar parametrisation points down and out: away from the bend.
    EXPECT_NEAR(g.first.curvature, -2 / (s * s * s), 1e-14);
    EXPECT_NEAR(g.second.curvature, -2 / s, 1e-14);
  }
}

TEST(LocalGeometry, DoesNotDependOnParameters) {
  Random random(1);
  for (int k = 0; k < 300; ++k) {
    const SurfaceJet jet{{},
                         uniform_vector(random, -1, 1),
                         uniform_vector(random, -1, 1),
                         uniform_vector(random, -1, 1),
                         uniform_vector(random, -1, 1),
                         uniform_vector(random, -1, 1)};
    if (length(cross(jet.du, jet.dv)) < 0.1) continue;
    const LocalGeometry g = local_geometry(jet);
    expect_consistent(g, jet);
    const double size = std::abs(g.first.curvature) + std::abs(g.second.curvature);
    // Skew parameters, nearly parallel: r_s and r_t at 1e-5 of each other; and the other orientation turns the signs.
    const LocalGeometry skew = local_geometry(reparametrised(jet, 1, 1, 0, 1e-5));
    EXPECT_NEAR(skew.first.curvature, g.first.curvature, 1e-4 * size);
    const LocalGeometry turned = local_geometry(reparametrised(jet, 0.5, 2, 0.25, -1));
    EXPECT_NEAR(turned.first.curvature, -g.second.curvature, 1e-11 * size);
    EXPECT_NEAR(turned.gaussian, g.gaussian, 1e-11 * size * size);
    EXPECT_LT(max_abs(turned.normal.direction + g.normal.direction), 1e-12);
    const LocalGeometry slow = local_geometry(reparametrised(jet, 1e-120, 0, 0, 1e80));
    EXPECT_NEAR(slow.first.curvature, g.first.curvature, 1e-12 * size);
  }
}

TEST(LocalGeometry, CloseCurvaturesKeepTheirDifference) {
  // H^2 - K would lose half the digits here.
  const LocalGeometry g = local_geometry(graph(0.5, 0, 0.5 - 1e-7));
  EXPECT_NEAR(g.first.curvature - g.second.curvature, 2e-7, 1e-15);
  EXPECT_FALSE(g.umbilic);
  EXPECT_TRUE(local_geometry(graph(0.5, 0, 0.5 - 1e-10)).umbilic);
  EXPECT_TRUE(local_geometry(graph(0, 0, 0)).umbilic);
}

TEST(LocalGeometry, UndefinedIsFlaggedAndZero) {
  const Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
  const SurfaceJet bad[] = {{{}, x, 2 * x, z, z, z},
                            {{}, {}, y, z, z, z},
                            {{}, {}, {}, {}, {}, {}},
                            {{}, x, x + 1e-12 * y, z, z, z},
                            {{}, {local_geometry_nan, 0, 0}, y, z, z, z},
                            {{}, x, y, {0, 0, local_geometry_nan}, z, z}};
  for (const SurfaceJet& jet : bad) {
    const LocalGeometry g = local_geometry(jet);
    EXPECT_FALSE(g.defined);
    for (const double value : {g.e, g.f, g.g, g.l, g.m, g.n, g.gaussian, g.mean, g.first.curvature, g.second.curvature})
      EXPECT_EQ(value, 0);
    EXPECT_EQ(g.first.direction, Vec3{});
  }
  // Out of range: only the normal is known.
  const LocalGeometry far = local_geometry(SurfaceJet{{}, 1e200 * x, 1e200 * y, z, z, z});
  EXPECT_FALSE(far.defined);
  EXPECT_EQ(far.normal.direction, z);
}

TEST(LocalGeometry, PolesHaveALimitNormalAlone) {
  const double h = std::sqrt(0.5);
  const std::vector<double> weights{1, h, 1, h, 0.5, h, 1, h, 1};
  const BezierPatch octant = rational(
      2, 2, {{1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}},
      weights);
  const LocalGeometry pole = local_geometry(octant, 1, 0.5);
  EXPECT_FALSE(pole.defined);
  EXPECT_EQ(pole.normal.kind, NormalKind::limit);
  EXPECT_EQ(pole.normal.direction, (Vec3{0, 0, -1}));
  const LocalGeometry near = local_geometry(octant, 1 - 1e-4, 0.5);
  ASSERT_TRUE(near.defined);
  EXPECT_NEAR(near.gaussian, 1, 1e-7);
  EXPECT_NEAR(local_geometry(octant, 0.3, 0.6).mean, 1, 1e-13);
  EXPECT_FALSE(local_geometry(octant, local_geometry_nan, 0).defined);
}

TEST(Net, OrthogonalAndConjugateOnes) {
  const auto report = [](const BezierPatch& patch) {
    const auto result = measure_net(patch);
    EXPECT_TRUE(result.ok());
    return *result;
  };
  // The octant of a sphere by longitude and latitude is a net whose isocurves are lines of curvature.
  const double h = std::sqrt(0.5);
  const BezierPatch octant = rational(
      2, 2, {{1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}},
      {1, h, 1, h, h * h, h, 1, h, 1});
  const NetReport sphere = report(octant);
  EXPECT_TRUE(sphere.orthogonal);
  EXPECT_TRUE(sphere.conjugate);
  EXPECT_EQ(sphere.undefined_samples, 17);
  EXPECT_LT(sphere.largest_cosine, 1e-12);
  EXPECT_LT(sphere.largest_mixed_curvature, 1e-12);
  // A translation surface (u, v, u^2 + v^2) is conjugate, not orthogonal: the cosine is 4uv / sqrt((1+4u^2)(1+4v^2)).
  const BezierPatch bowl = polynomial(
      2, 2,
      {{0, 0, 0}, {0, 0.5, 0}, {0, 1, 1}, {0.5, 0, 0}, {0.5, 0.5, 0}, {0.5, 1, 1}, {1, 0, 1}, {1, 0.5, 1}, {1, 1, 2}});
  const NetReport translation = report(bowl);
  EXPECT_FALSE(translation.orthogonal);
  EXPECT_TRUE(translation.conjugate);
  EXPECT_NEAR(translation.largest_cosine, 0.8, 1e-15);
  EXPECT_EQ(translation.volume_bound, 0);
  EXPECT_NEAR(translation.dot_bound, 4, 1e-14);
  // (u, v, uv): r_u . r_v = uv, r_uv . N = 1 / sqrt(1 + u^2 + v^2).
  const NetReport saddle = report(polynomial(1, 1, {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 1}}));
  EXPECT_FALSE(saddle.orthogonal);
  EXPECT_FALSE(saddle.conjugate);
  EXPECT_NEAR(saddle.largest_cosine, 0.5, 1e-15);
  EXPECT_NEAR(saddle.largest_mixed_curvature, 1, 1e-15);
  EXPECT_NEAR(saddle.volume_bound, 1, 1e-15);
}

TEST(Net, BoundsAreAboveEverySample) {
  Random random(2);
  for (int k = 0; k < 40; ++k) {
    const int m = 1 + k % 4, n = 1 + k % 3;
    const BezierPatch patch = k % 2 ? random_rational(random, m, n, 0.7, 1.4) : random_polynomial(random, m, n);
    const auto report = measure_net(patch, {.samples = 3});
    ASSERT_TRUE(report.ok());
    for (int s = 0; s < 50; ++s) {
      const SurfaceJet jet = evaluate_jet(patch, uniform(random, 0, 1), uniform(random, 0, 1));
      EXPECT_LE(std::abs(dot(jet.du, jet.dv)), report->dot_bound * (1 + 1e-12));
      EXPECT_LE(std::abs(dot(jet.duv, cross(jet.du, jet.dv))), report->volume_bound * (1 + 1e-12));
    }
  }
}

TEST(Net, RefusesBadOptions) {
  const BezierPatch patch = polynomial(1, 1, {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 1}});
  EXPECT_EQ(measure_net(patch, {.samples = 1}).status().code(), StatusCode::invalid_argument);
  EXPECT_EQ(measure_net(patch, {.samples = 1001}).status().code(), StatusCode::invalid_argument);
  EXPECT_EQ(measure_net(patch, {.tolerance = local_geometry_nan}).status().code(), StatusCode::invalid_argument);
  const auto dot = measure_net(polynomial(1, 1, std::vector<Vec3>(4)));
  ASSERT_TRUE(dot.ok());
  EXPECT_EQ(dot->undefined_samples, 17 * 17);
}

}}  // namespace tessera::test
