// Functions of the caller's: values, errors, and derivatives by series, by differences and over discs.

#include "tessera/parametric_surface.h"

#include <stdexcept>

#include "support/errors.h"
#include "support/lecture_surfaces.h"
#include "support/random_patches.h"
#include "support/synthetic_sets.h"
#include "support/ulp.h"

namespace tessera::test { namespace {

/// A function that provides only positions.
template <class F>
ParametricSurface bare(const F& f, const Domain& domain = F::domain) {
  SurfaceFunctions functions;
  functions.position = [f](double u, double v) {
    const auto p = f(u, v);
    return Vec3{p[0], p[1], p[2]};
  };
  return value_of(ParametricSurface::make(std::move(functions), domain));
}

void expect_near(const Vec3& a, const Vec3& b, double tolerance, const char* what) {
  EXPECT_LE(max_abs(a - b), tolerance) << what << ": (" << a.x << ", " << a.y << ", " << a.z << ") and (" << b.x << ", "
                                       << b.y << ", " << b.z << ")";
}

void expect_near(const SurfaceJet& a, const SurfaceJet& b, double first, double second) {
  expect_near(a.position, b.position, 1e-15, "position");
  expect_near(a.du, b.du, first, "du");
  expect_near(a.dv, b.dv, first, "dv");
  expect_near(a.duu, b.duu, second, "duu");
  expect_near(a.duv, b.duv, second, "duv");
  expect_near(a.dvv, b.dvv, second, "dvv");
}

TEST(ParametricSurface, InversesOfTheLecturesFindTheParameters) {
  Random random(1);
  const auto check = [&](const auto& f, const ParametricSurface& surface) {
    for (int k = 0; k < 100; ++k) {
      const Domain& d = surface.domain();
      const double u = d.u_at(uniform(random, 0, 1)), v = d.v_at(uniform(random, 0, 1));
      const auto [a, b] = f.inverse(value_of(surface.position(u, v)));
      EXPECT_NEAR(a, u, 1e-14);
      EXPECT_NEAR(b, v, 1e-14);
    }
  };
  check(Plane{}, value_of(generic_surface(Plane{}, Plane::domain)));
  check(Cylinder{}, value_of(generic_surface(Cylinder{}, Cylinder::domain)));
  check(Paraboloid{}, value_of(generic_surface(Paraboloid{}, Paraboloid::domain)));
  const auto over_disc = [&](const auto& f) {
    const ParametricSurface surface = value_of(generic_surface_over_disc(f));
    const PolarMap map = value_of(PolarMap::make({}));
    for (int k = 0; k < 100; ++k) {
      const double rho = uniform(random, 0, 1), theta = uniform(random, 0, 2 * pi);
      const Vec3 p = value_of(surface.position(rho, theta));
      EXPECT_NEAR(length(p), 1, 1e-15);
      const auto [x, y] = f.inverse(p);
      EXPECT_NEAR(x, map(rho, theta)[0], 1e-15);
      EXPECT_NEAR(y, map(rho, theta)[1], 1e-15);
    }
  };
  over_disc(RootHemisphere{});
  over_disc(RationalHemisphere{});
}

TEST(ParametricSurface, SeriesGiveDerivatives) {
  const ParametricSurface torus = value_of(generic_surface(Torus{}, Torus::domain));
  EXPECT_TRUE(torus.has_derivatives());
  EXPECT_TRUE(torus.has_bounds());
  Random random(2);
  for (int k = 0; k < 50; ++k) {
    const double u = uniform(random, 0, 2 * pi), v = uniform(random, 0, 2 * pi);
    const double c = std::cos(u), s = std::sin(u), r = 3 + std::cos(v), a = -std::sin(v), b = -std::cos(v);
    const SurfaceJet expected{{r * c, r * s, std::sin(v)}, {-r * s, r * c, 0}, {a * c, a * s, std::cos(v)},
                              {-r * c, -r * s, 0},         {-a * s, a * c, 0}, {b * c, b * s, -std::sin(v)}};
    expect_near(value_of(evaluate_jet(torus, u, v)), expected, 1e-15, 1e-15);
  }
}

TEST(ParametricSurface, DifferencesKeepTheirStatedError) {
  // The torus: |p| <= 4.2, all derivatives at most 4, L = 2 pi, h = L / 256.
  const double length = 2 * pi, h6 = std::pow(length / 256, 6), h5 = std::pow(length / 256, 5), size = 4.2;
  const ParametricSurface known = value_of(generic_surface(Torus{}, Torus::domain)), unknown = bare(Torus{});
  EXPECT_FALSE(unknown.has_derivatives());
  Random random(3);
  for (int k = 0; k < 400; ++k) {
    // Some next to edges and corners.
    const double near = k % 4 == 0 ? 0.01 : 1;
    const double u = k % 8 == 0 ? 2 * pi - near * uniform(random, 0, 1) : near * uniform(random, 0, 2 * pi);
    const double v = k % 4 == 1 ? 2 * pi : uniform(random, 0, 2 * pi);
    const auto inner = [&](double t) { return t > 3 * length / 256 && t < length - 3 * length / 256; };
    const bool both = inner(u) && inner(v);
    const SurfaceJet a = value_of(evaluate_jet(known, u, v)), b = value_of(evaluate_jet(unknown, u, v));
    const auto first = [&](double t) {
      return inner(t) ? h6 * 4 / 140 + 0x1p-42 * size / length : h6 * 4 / 7 + 0x1p-39 * size / length;
    };
    const auto second = [&](double t) {
      return inner(t) ? h6 * 4 / 560 + 0x1p-33 * size / length / length
                      : 0.7 * h5 * 4 + 0x1p-29 * size / length / length;
    };
    const double mixed = both ? h6 * 4 / 140 + h6 * 4 / 63 + 0x1p-33 * size / length / length
                              : h6 * 4 / 7 + 9 * h6 * 4 + 0x1p-25 * size / length / length;
    expect_near(a.du, b.du, first(u), "du");
    expect_near(a.dv, b.dv, first(v), "dv");
    expect_near(a.duu, b.duu, second(u), "duu");
    expect_near(a.dvv, b.dvv, second(v), "dvv");
    expect_near(a.duv, b.duv, mixed, "duv");
  }
}

TEST(ParametricSurface, PolarPointsStayInTheDisc) {
  Random random(4);
  const auto check = [&](const Disc& disc) {
    const ParametricSurface root = value_of(ParametricSurface::over_disc(
        {.position =
             [disc](double x, double y) {
               const double a = x - disc.x, b = y - disc.y, r = disc.radius;
               return Vec3{std::sqrt(r * r - a * a - b * b), std::sqrt(r * r - (a * a + b * b)),
                           std::sqrt((r * r - b * b) - a * a)};
             }},
        disc));
    const PolarMap map = value_of(PolarMap::make(disc));
    for (int k = 0; k <= 20000; ++k) {
      const double theta = k <= 64 ? k * pi / 32 : uniform(random, 0, 2 * pi);
      const auto rim = root.position(disc.radius, std::min(theta, root.domain().v1));
      ASSERT_TRUE(rim.ok()) << rim.status().message();
      const auto [x, y] = map(disc.radius, theta);
      const double short_of = disc.radius - std::hypot(x - disc.x, y - disc.y);
      ASSERT_LE(short_of, 0x1p-52 * (7 * disc.radius + 2 * (std::abs(disc.x) + std::abs(disc.y))));
    }
  };
  check({});
  check({.radius = 3});
  check({.radius = 1.2345678e-7});
  check({.x = 0.3, .y = -7.7, .radius = 2.1});
  check({.x = 1e6, .y = 2e5, .radius = 0.1});
}

TEST(ParametricSurface, PolarMapClosesAndCollapses) {
  const PolarMap map = value_of(PolarMap::make({.x = 0.1, .y = -0.7, .radius = 3}));
  EXPECT_EQ(map.domain(), (Domain{0, 3, 0, 2 * pi}));
  for (const double rho : {0.0, 0.5, 3.0}) EXPECT_EQ(map(rho, 2 * pi), map(rho, 0));
  for (const double theta : {0.0, 1.0, 4.0}) EXPECT_EQ(map(0, theta), (std::array<double, 2>{0.1, -0.7}));
}

TEST(ParametricSurface, DerivativesOverADiscGoThroughTheMap) {
  // The surface by x and y, against series through the map, and against differences.
  const Disc disc{.x = 0.3, .y = -0.2, .radius = 0.5};
  SurfaceFunctions functions = generic::surface_functions(RootHemisphere{});
  const ParametricSurface given = value_of(ParametricSurface::over_disc(functions, disc));
  EXPECT_FALSE(given.has_bounds());
  functions.jet = {};
  const ParametricSurface unknown = value_of(ParametricSurface::over_disc(functions, disc));
  const ParametricSurface series = value_of(generic_surface_over_disc(RootHemisphere{}, disc));
  EXPECT_TRUE(series.has_bounds());
  Random random(5);
  for (int k = 0; k < 50; ++k) {
    const double rho = uniform(random, 0, 0.5), theta = uniform(random, 0, 2 * pi);
    const SurfaceJet jet = value_of(evaluate_jet(given, rho, theta));
    expect_near(jet, value_of(evaluate_jet(series, rho, theta)), 1e-14, 1e-13);
    expect_near(jet, value_of(evaluate_jet(unknown, rho, theta)), 1e-8, 1e-6);
  }
}

TEST(ParametricSurface, BoundsHoldDerivatives) {
  const ParametricSurface torus = value_of(generic_surface(Torus{}, Torus::domain));
  // d^4/du^4: 3 + cos v at most; d^4/dv^4: 1.
  const auto whole = torus.derivative_bounds(Torus::domain, 4);
  EXPECT_GE(whole[0], 4);
  EXPECT_LE(whole[0], 6);
  EXPECT_GE(whole[1], 1);
  EXPECT_LE(whole[1], 3);
  const auto part = torus.derivative_bounds({1, 1.01, 0, 0.01}, 16);
  EXPECT_NEAR(part[0], 4, 0.1);
  EXPECT_NEAR(part[1], 1, 0.1);
  EXPECT_EQ(torus.derivative_bounds({1, 1.01, 0, 0.01}, 17), (std::array<double, 2>{infinity, infinity}));
  const ParametricSurface root = value_of(generic_surface_over_disc(RootHemisphere{}));
  EXPECT_EQ(root.derivative_bounds({0.9, 1, 0, 0.1}, 4)[0], infinity);
  EXPECT_LT(root.derivative_bounds({0, 0.1, 0, 0.1}, 4)[0], 10);
  EXPECT_EQ(bare(Plane{}).derivative_bounds(Plane::domain, 4)[0], infinity);
}

TEST(ParametricSurface, BoundsThatThrowOrAreNotNumbersAreNone) {
  SurfaceFunctions functions = generic::surface_functions(Plane{});
  functions.derivative_bounds = [](const Domain&, int) { return std::array<double, 2>{not_a_number, -1}; };
  EXPECT_EQ(value_of(ParametricSurface::make(functions)).derivative_bounds({}, 1)[0], infinity);
  EXPECT_EQ(value_of(ParametricSurface::make(functions)).derivative_bounds({}, 1)[1], infinity);
  functions.derivative_bounds = [](const Domain&, int) -> std::array<double, 2> { throw std::runtime_error("no"); };
  EXPECT_EQ(value_of(ParametricSurface::make(functions)).derivative_bounds({}, 1)[0], infinity);
}

TEST(ParametricSurface, RefusesBadInput) {
  const auto flat = [](double u, double v) { return Vec3{u, v, 0}; };
  using Surface = ParametricSurface;
  expect_refused(Surface::make({}), StatusCode::invalid_argument, -1, "no function for its position");
  expect_refused(Surface::over_disc({}), StatusCode::invalid_argument, -1, "no function for its position");
  expect_refused(Surface::make({.position = flat}, {0, 0, 0, 1}), StatusCode::invalid_argument, -1, "along u, [0, 0]");
  expect_refused(Surface::make({.position = flat}, {0, 1, 2, 1}), StatusCode::invalid_argument, -1, "along v, [2, 1]");
  expect_refused(Surface::make({.position = flat}, {0, not_a_number, 0, 1}), StatusCode::non_finite, -1, "along u");
  expect_refused(Surface::make({.position = flat}, {-1e308, 1.5e308, 0, 1}), StatusCode::invalid_argument, -1,
                 "too long");
  const auto log = [](double u, double v) { return Vec3{u, v, std::log(u)}; };
  expect_refused(Surface::make({.position = log}), StatusCode::non_finite, -1, "(u, v) = (0, 0) is (0, 0, -inf)");
  for (const double radius : {0.0, -1.0, 1e-320})
    expect_refused(Surface::over_disc({.position = flat}, {.radius = radius}), StatusCode::invalid_argument, -1,
                   "radius");
  expect_refused(Surface::over_disc({.position = flat}, {.x = 1, .radius = 1e-16}), StatusCode::invalid_argument, -1,
                 "below the rounding of its centre");
  expect_refused(Surface::over_disc({.position = flat}, {.x = infinity}), StatusCode::non_finite, -1, "finite");
  expect_refused(Surface::over_disc({.position = flat}, {.radius = not_a_number}), StatusCode::non_finite, -1,
                 "finite");
}

TEST(ParametricSurface, FunctionsThatFailBecomeErrors) {
  const auto throws = [](double u, double v) -> Vec3 {
    if (u == 0.5) throw std::runtime_error("half");
    if (v == 0.5) throw 7;
    if (u == 0.25) throw std::bad_alloc();
    return {u, v, u == 0.75 ? not_a_number : 0};
  };
  const ParametricSurface surface = value_of(ParametricSurface::make({.position = throws}));
  expect_refused(surface.position(0.5, 0), StatusCode::invalid_argument, -1, "at (u, v) = (0.5, 0) threw: half");
  expect_refused(surface.position(0, 0.5), StatusCode::invalid_argument, -1, "(0, 0.5)");
  expect_refused(surface.position(0.25, 0), StatusCode::out_of_memory, -1, "");
  expect_refused(surface.position(0.75, 1), StatusCode::non_finite, -1, "(0.75, 1) is (0.75, 1, nan)");
  expect_refused(evaluate_jet(surface, 0.5, 0.1), StatusCode::invalid_argument, -1, "half");
  // A root's derivative at its zero is an error that names it, not a value.
  const ParametricSurface root = value_of(generic_surface([](auto u, auto v) {
    using std::sqrt;
    using T = decltype(u);
    return std::array<T, 3>{u, v, sqrt(u)};
  }));
  expect_refused(evaluate_jet(root, 0, 0.5), StatusCode::non_finite, -1, "derivative by u at (u, v) = (0, 0.5)");
  EXPECT_TRUE(root.position(0, 0.5).ok());
}

TEST(ParametricCurve, FromOneExpression) {
  const auto helix = [](auto t) {
    using std::cos, std::sin;
    using T = decltype(t);
    return std::array<T, 3>{cos(t), sin(t), 2 * t};
  };
  const ParametricCurve curve = value_of(generic_curve(helix, {0, 10}));
  const CurveJet jet = value_of(evaluate_jet(curve, 3));
  expect_near(jet.position, {std::cos(3.0), std::sin(3.0), 6}, 0, "position");
  expect_near(jet.first, {-std::sin(3.0), std::cos(3.0), 2}, 1e-15, "first");
  expect_near(jet.second, {-std::cos(3.0), -std::sin(3.0), 0}, 1e-15, "second");
  EXPECT_GE(curve.derivative_bound({0, 0.1}, 1), std::sqrt(5.0));
  EXPECT_NEAR(curve.derivative_bound({0, 0.1}, 1), std::sqrt(5.0), 0.1);
  EXPECT_GE(curve.derivative_bound({0, 0.01}, 12), 1);
  EXPECT_NEAR(curve.derivative_bound({0, 0.01}, 12), 1, 0.1);
}

}}  // namespace tessera::test
