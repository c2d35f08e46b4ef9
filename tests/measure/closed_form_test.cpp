// Areas, volumes and moments of bodies whose true values are known in closed form.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "measure/measure_bodies.h"
#include "tessera/generic_callable.h"
#include "tessera/nurbs_surface.h"
#include "trim/trim_shapes.h"

namespace tessera::test { namespace {

constexpr double pi = std::numbers::pi;

QuadricPiece ellipsoid(double a, double b, double c) {
  return piece(quadric({1 / (a * a), 1 / (b * b), 1 / (c * c), 0, 0, 0, 0, 0, 0, -1}), {-pi, pi, -pi / 2, pi / 2});
}
QuadricPiece cylinder(double radius, double height) {
  return piece(quadric({1 / (radius * radius), 1 / (radius * radius), 0, 0, 0, 0, 0, 0, 0, -1}), {-pi, pi, 0, height});
}
QuadricPiece cone(double slope, double from, double to) {
  return piece(quadric({1 / (slope * slope), 1 / (slope * slope), -1, 0, 0, 0, 0, 0, 0, 0}), {-pi, pi, from, to});
}
QuadricPiece paraboloid(double a, double to) {
  return piece(quadric({1 / (a * a), 1 / (a * a), 0, 0, 0, 0, 0, 0, -0.5, 0}), {-pi, pi, 0, to});
}

/// A square of the plane z = 0 with side 2 size about zero, its normal up.
ModelSurface plane(double size, const Affine& map, const std::vector<TrimLoop>& loops) {
  const std::vector<Vec3> corners{{-size, -size, 0}, {-size, size, 0}, {size, -size, 0}, {size, size, 0}};
  ModelSurface of = placed_surface(polynomial(1, 1, corners), map);
  of.trims = loops;
  return of;
}
/// A disc of the plane z = 0.
ModelSurface disc(double radius, const Affine& map) { return plane(radius, map, {circle({0.5, 0.5}, 0.5)}); }
Affine turned_over() { return Affine::rotated({1, 0, 0}, pi); }

/// A torus of revolution as a rational biquadratic.
Surface torus(double major, double minor) {
  constexpr double x[] = {1, 1, 0, -1, -1, -1, 0, 1, 1}, y[] = {0, 1, 1, 1, 0, -1, -1, -1, 0};
  std::vector<Vec3> points;
  std::vector<double> weights;
  const auto w = [](int k) { return k % 2 == 0 ? 1 : std::sqrt(0.5); };
  for (int i = 0; i < 9; ++i)
    for (int j = 0; j < 9; ++j) {
      const double r = major + minor * x[j];
      points.push_back({r * x[i], r * y[i], minor * y[j]});
      weights.push_back(w(i) * w(j));
    }
  const std::vector<double> knots{0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4};
  return value_of(BSplineSurface::rational(2, knots, 2, knots, points, weights));
}

TEST(ClosedForm, SpheresOfAnySizeAnywhere) {
  for (const double radius : {1e-6, 1.0, 3.0, 1e6})
    for (const double far : {0.0, 1e3}) {
      const Vec3 at = far * radius * Vec3{1, -2, 0.5};
      const std::vector<ModelSurface> ball{placed_surface(ellipsoid(radius, radius, radius), Affine::translated(at))};
      const std::string what = std::to_string(radius) + " at " + std::to_string(far);
      const AreaMeasures area = value_of(measure_surfaces(model_of(ball)));
      expect_measured(area.total.area, 4 * pi * radius * radius, 1e-9, what);
      expect_point(area.total.centroid, at, 1e-8 * radius, what);
      EXPECT_TRUE(area.total.proven && area.surfaces[0].proven);
      const BodyMeasures body = value_of(measure_enclosed(ball));
      const double volume = 4.0 / 3.0 * pi * std::pow(radius, 3);
      expect_measured(body.volume, volume, 1e-9, what);
      expect_point(body.centroid, at, 1e-8 * radius, what);
      const double inertia = 0.4 * volume * radius * radius;
      for (const double entry : {body.inertia.xx, body.inertia.yy, body.inertia.zz})
        expect_measured({entry, body.inertia.error}, inertia, 1e-7, what);
      for (const double moment : body.inertia.moments)
        expect_measured({moment, body.inertia.moments_error}, inertia, 1e-7, what);
      EXPECT_TRUE(body.proven);
      EXPECT_EQ(body.gap, 0);
    }
}

TEST(ClosedForm, EllipsoidsHaveTheirPrincipalAxes) {
  const double a = 1, b = 2.5, c = 4;
  const Affine turn = Affine::translated({3, -1, 2}) * Affine::rotated({1, 2, 3}, 0.7);
  const BodyMeasures body = value_of(measure_enclosed(std::vector{placed_surface(ellipsoid(a, b, c), turn)}));
  const double volume = 4.0 / 3.0 * pi * a * b * c;
  expect_measured(body.volume, volume, 1e-9, "ellipsoid");
  expect_point(body.centroid, {3, -1, 2}, 1e-8, "ellipsoid");
  const double truth[] = {volume / 5 * (a * a + b * b), volume / 5 * (a * a + c * c), volume / 5 * (b * b + c * c)};
  // Rising moments belong to the axes z, y, x of the ellipsoid.
  const Vec3 axes[] = {turn.columns[2], turn.columns[1], turn.columns[0]};
  for (std::size_t k = 0; k < 3; ++k) {
    expect_measured({body.inertia.moments[k], body.inertia.moments_error}, truth[k], 1e-7, "moment");
    EXPECT_NEAR(std::abs(dot(body.inertia.axes[k], axes[k])), 1, 1e-12);
  }
  EXPECT_NEAR(dot(cross(body.inertia.axes[0], body.inertia.axes[1]), body.inertia.axes[2]), 1, 1e-12);
}

TEST(ClosedForm, TheTorus) {
  const double major = 3, minor = 1.25;
  const std::vector<ModelSurface> ring{placed_surface(torus(major, minor))};
  expect_measured(value_of(measure_surfaces(model_of(ring))).total.area, 4 * pi * pi * major * minor, 1e-9, "area");
  const BodyMeasures body = value_of(measure_enclosed(ring));
  const double volume = 2 * pi * pi * major * minor * minor;
  expect_measured(body.volume, volume, 1e-9, "volume");
  expect_measured({body.inertia.zz, body.inertia.error}, volume * (major * major + 0.75 * minor * minor), 1e-8, "zz");
  expect_measured({body.inertia.xx, body.inertia.error}, volume * (0.5 * major * major + 0.625 * minor * minor), 1e-8,
                  "xx");
}

/// A torus around z by its formula; a minor angle of -pi/2 to pi/2 about a major radius of 0 gives a sphere.
struct RoundSurface {
  double major, minor;
  template <class T>
  std::array<T, 3> operator()(const T& u, const T& v) const {
    using std::cos, std::sin;
    const T distance = major + minor * cos(v);
    return {distance * cos(u), distance * sin(u), minor * sin(v)};
  }
};

TEST(ClosedForm, FormulasCountTheirFit) {
  for (const double size : {1e-3, 1.0, 1e3}) {
    const RoundSurface ball{0, 2 * size}, ring{3 * size, 1.25 * size};
    const Surface surfaces[] = {value_of(generic_surface(ball, {-pi, pi, -pi / 2, pi / 2})),
                                value_of(generic_surface(ring, {-pi, pi, -pi, pi}))};
    const double areas[] = {16 * pi * size * size, 4 * pi * pi * ring.major * ring.minor};
    const double volumes[] = {32.0 / 3.0 * pi * std::pow(size, 3), 2 * pi * pi * ring.major * ring.minor * ring.minor};
    for (std::size_t k = 0; k < 2; ++k) {
      const std::string what = "surface " + std::to_string(k) + " of size " + std::to_string(size);
      const std::vector<ModelSurface> all{placed_surface(surfaces[k], Affine::translated({size, -size, 0}))};
      const SurfaceMeasures found = value_of(measure_surfaces(model_of(all))).total;
      EXPECT_FALSE(found.proven);
      expect_measured(found.area, areas[k], 2e-3, what);
      expect_point(found.centroid, {size, -size, 0}, 1e-2 * size, what);
      expect_measured(value_of(measure_enclosed(all)).volume, volumes[k], 1e-4, what);
    }
  }
}

TEST(ClosedForm, SidesOfConesCylindersAndParaboloids) {
  const auto area = [](const QuadricPiece& side) {
    return value_of(measure_surfaces(model_of({placed_surface(side)}))).total.area;
  };
  expect_measured(area(cylinder(1.5, 4)), 2 * pi * 1.5 * 4, 1e-9, "cylinder");
  expect_measured(area(cone(0.75, 0, 2)), pi * 1.5 * std::hypot(1.5, 2), 1e-9, "cone with its apex");
  expect_measured(area(cone(0.75, 1, 2)), pi * (1.5 + 0.75) * std::hypot(0.75, 1), 1e-9, "frustum");
  expect_measured(area(paraboloid(1, 2)), pi / 6 * (std::pow(17.0, 1.5) - 1), 1e-9, "paraboloid");
}

TEST(ClosedForm, BodiesWithTrimmedCaps) {
  const double r = 1.5, h = 4;
  const std::vector<ModelSurface> can{placed_surface(cylinder(r, h)), disc(r, Affine::translated({0, 0, h})),
                                      disc(r, turned_over())};
  const BodyMeasures body = value_of(measure_enclosed(can));
  expect_measured(body.volume, pi * r * r * h, 1e-9, "can");
  expect_point(body.centroid, {0, 0, h / 2}, 1e-8, "can");
  expect_measured({body.inertia.zz, body.inertia.error}, pi * r * r * h * r * r / 2, 1e-8, "can");
  const AreaMeasures area = value_of(measure_surfaces(model_of(can)));
  expect_measured(area.surfaces[1].area, pi * r * r, 1e-9, "cap");
  EXPECT_TRUE(area.total.proven);
  const std::vector<ModelSurface> hat{placed_surface(cone(0.5, 0, 3)), disc(1.5, Affine::translated({0, 0, 3}))};
  const BodyMeasures cone_body = value_of(measure_enclosed(hat));
  expect_measured(cone_body.volume, pi * 1.5 * 1.5, 1e-9, "cone");
  expect_point(cone_body.centroid, {0, 0, 2.25}, 1e-8, "cone");
}

TEST(ClosedForm, Annuli) {
  const double far = 1e4;
  for (const double scale : {1e-3, 1.0, 1e5}) {
    const Affine map = Affine::translated(scale * far * Vec3{1, 1, -1}) * Affine::rotated({1, 1, 0}, 0.4);
    const std::vector<TrimLoop> loops{circle({0.5, 0.5}, 0.4), circle({0.6, 0.5}, 0.25, true)};
    const AreaMeasures area = value_of(measure_surfaces(model_of({plane(scale, map, loops)})));
    const double outer = pi * 0.64 * scale * scale, inner = pi * 0.25 * scale * scale;
    expect_measured(area.total.area, outer - inner, 1e-8, "annulus");
    // u runs along x, from -scale to scale.
    const Vec3 centroid = map.point({-inner * 0.2 * scale / (outer - inner), 0, 0});
    expect_point(area.total.centroid, centroid, 1e-8 * scale, "annulus");
    EXPECT_TRUE(area.total.proven);
  }
}

TEST(ClosedForm, ABoxWithAHole) {
  const double r = 0.5;
  const std::vector<TrimLoop> hole{circle({0.5, 0.5}, 0.25, true)};
  std::vector<ModelSurface> body{plane(1, Affine::translated({0, 0, 3}), hole), plane(1, turned_over(), hole)};
  // The sides of the box, and the hole's, with its normals turned inwards by a mirror.
  for (int k = 0; k < 4; ++k) {
    const Affine turn = Affine::rotated({0, 0, 1}, k * pi / 2);
    std::vector<Vec3> corners;
    for (const Vec3& p : {Vec3{1, -1, 0}, Vec3{1, -1, 3}, Vec3{1, 1, 0}, Vec3{1, 1, 3}})
      corners.push_back(turn.point(p));
    body.push_back(placed_surface(polynomial(1, 1, corners)));
  }
  body.push_back(placed_surface(cylinder(r, 3), Affine::scaled({1, -1, 1})));
  const BodyMeasures found = value_of(measure_enclosed(body));
  const double box = 12, drill = pi * r * r * 3;
  expect_measured(found.volume, box - drill, 1e-9, "drilled");
  expect_point(found.centroid, {0, 0, 1.5}, 1e-8, "drilled");
  expect_measured({found.inertia.zz, found.inertia.error}, box * 8 / 12 - drill * r * r / 2, 1e-8, "drilled");
  const AreaMeasures area = value_of(measure_surfaces(model_of(body)));
  expect_measured(area.total.area, 2 * (4 - pi * r * r) + 24 + 2 * pi * r * 3, 1e-9, "drilled");
}

/// The volume between a polynomial height over the unit square and the plane z = 0 is the mean of its control heights.
TEST(ClosedForm, PolynomialHeights) {
  Random random(7);
  for (const auto& [m, n] : {std::pair(1, 1), {2, 3}, {3, 3}, {5, 4}, {9, 2}, {15, 15}}) {
    std::vector<Vec3> points;
    double mean = 0, first = 0;
    for (int i = 0; i <= m; ++i)
      for (int j = 0; j <= n; ++j) {
        const double height = uniform(random, 1, 2);
        points.push_back({double(i) / m, double(j) / n, height});
        mean += height / ((m + 1) * (n + 1));
        // The integral of u B_i is (i + 1) / ((m + 1) (m + 2)).
        first += height * (i + 1) / ((m + 1) * (m + 2.0) * (n + 1));
      }
    const BezierPatch top = polynomial(m, n, points);
    std::vector<BezierPatch> body{top};
    for (const Side side : {Side::v0, Side::u1, Side::v1, Side::u0}) {
      BezierPolygon upper = value_of(boundary_curve(top, side));
      if (side == Side::v0 || side == Side::u1) upper = reversed(upper);
      BezierPolygon lower = upper;
      for (Vec3& p : lower.points) p.z = 0;
      body.push_back(value_of(make_ruled(lower, upper)));
    }
    body.push_back(polynomial(1, 1, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}));
    const BodyMeasures found = value_of(measure_enclosed(surfaces_of(body)));
    const std::string what = "degrees " + std::to_string(m) + ", " + std::to_string(n);
    expect_measured(found.volume, mean, 1e-8, what);
    EXPECT_LE(std::abs(found.centroid.value.x - first / mean), found.centroid.error) << what;
    EXPECT_TRUE(found.proven);
  }
}

}}  // namespace tessera::test
