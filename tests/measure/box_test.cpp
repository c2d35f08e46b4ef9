// Tight boxes contain their models and are within their errors.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "measure/measure_bodies.h"
#include "trim/trim_shapes.h"

namespace tessera::test { namespace {

void expect_box(const MeasuredBox& found, const Box3& truth, double most, const std::string& what) {
  const double slack = 1e-15 * std::max(max_abs(truth.lower), max_abs(truth.upper));  // of the truth itself
  const auto check = [&](double outer, double inner, double error) {
    EXPECT_GE(outer, inner - slack) << what;
    EXPECT_LE(outer - error, inner + slack) << what;
    EXPECT_LE(error, most) << what;
  };
  check(-found.box.lower.x, -truth.lower.x, found.lower_error.x);
  check(-found.box.lower.y, -truth.lower.y, found.lower_error.y);
  check(-found.box.lower.z, -truth.lower.z, found.lower_error.z);
  check(found.box.upper.x, truth.upper.x, found.upper_error.x);
  check(found.box.upper.y, truth.upper.y, found.upper_error.y);
  check(found.box.upper.z, truth.upper.z, found.upper_error.z);
}

TEST(TightBox, OfEllipsoidsTurnedAnyWay) {
  constexpr double pi = std::numbers::pi;
  const Vec3 size{1, 2.5, 0.25};
  for (int k = 0; k < 12; ++k) {
    const Affine map = Affine::translated({double(k), -100, 0}) * Affine::rotated({1, double(k), 2}, 0.3 * k);
    const QuadricPiece of =
        piece(quadric({1 / (size.x * size.x), 1 / (size.y * size.y), 1 / (size.z * size.z), 0, 0, 0, 0, 0, 0, -1}),
              {-pi, pi, -pi / 2, pi / 2});
    const Vec3 x = size.x * map.columns[0], y = size.y * map.columns[1], z = size.z * map.columns[2];
    const Vec3 reach{std::hypot(x.x, y.x, z.x), std::hypot(x.y, y.y, z.y), std::hypot(x.z, y.z, z.z)};
    const Vec3 at = map.point({});
    expect_box(value_of(measure_box(model_of({placed_surface(of, map)}))), {at - reach, at + reach}, 1e-9,
               std::to_string(k));
  }
}

TEST(TightBox, OfDiscsCutFromPlanesAtASlant) {
  const std::vector<Vec3> corners{{-1, -1, 0}, {-1, 1, 0}, {1, -1, 0}, {1, 1, 0}};
  for (int k = 0; k < 12; ++k) {
    const Affine map = Affine::rotated({3, double(k), 1}, 0.4 * k);
    ModelSurface disc = placed_surface(polynomial(1, 1, corners), map);
    disc.trims = std::vector<TrimLoop>{circle({0.6, 0.5}, 0.3)};
    const Vec3 at = map.point({0.2, 0, 0}), x = 0.6 * map.columns[0], y = 0.6 * map.columns[1];
    const Vec3 reach{std::hypot(x.x, y.x), std::hypot(x.y, y.y), std::hypot(x.z, y.z)};
    const MeasuredBox box = value_of(measure_box(model_of({disc})));
    expect_box(box, {at - reach, at + reach}, 1e-9, std::to_string(k));
    EXPECT_TRUE(box.proven);
  }
}

TEST(TightBox, OfTrianglesCutFromAPatch) {
  Random random(5);
  for (int k = 0; k < 20; ++k) {
    std::vector<Vec3> points;
    for (int i = 0; i <= 3; ++i)
      for (int j = 0; j <= 3; ++j) points.push_back(Vec3{i / 3.0, j / 3.0, 0} + uniform_vector(random, -0.3, 0.3));
    const BezierPatch patch = polynomial(3, 3, points);
    ModelSurface face = placed_surface(patch);
    const auto at = [&] { return ParameterPoint{uniform(random, 0, 1), uniform(random, 0, 1)}; };
    const ParameterPoint a = at(), b = at(), c = at();
    face.trims = std::vector<TrimLoop>{polygon({a, b, c})};
    const MeasuredBox found = value_of(measure_box(model_of({face})));
    EXPECT_LE(std::max(max_abs(found.lower_error), max_abs(found.upper_error)), 1e-8) << k;
    Box3 samples;
    constexpr int n = 400;
    for (int i = 0; i <= n; ++i)
      for (int j = 0; i + j <= n; ++j) {
        const double s = double(i) / n, t = double(j) / n, r = 1 - s - t;
        samples.extend(de_casteljau(patch, r * a.u + s * b.u + t * c.u, r * a.v + s * b.v + t * c.v));
      }
    Box3 grown = found.box;
    grown.lower = grown.lower - Vec3{1e-14, 1e-14, 1e-14}, grown.upper += Vec3{1e-14, 1e-14, 1e-14};
    EXPECT_TRUE(grown.contains(samples)) << k;
    // Between samples, a smooth maximum rises by less than this.
    const double fine = 2e-5;
    EXPECT_LE(max_abs(found.box.upper - samples.upper), fine) << k;
    EXPECT_LE(max_abs(found.box.lower - samples.lower), fine) << k;
  }
}

TEST(TightBox, IsInsideTheBoxOfControlPoints) {
  const Model model = model_of(surfaces_of(closed_body()));
  const MeasuredBox found = value_of(measure_box(model));
  const Box3 hull = value_of(make_patch_set(model)).box();
  EXPECT_LT(found.box.diagonal(), 0.99 * hull.diagonal());
  EXPECT_LE(std::max(max_abs(found.lower_error), max_abs(found.upper_error)), 1e-9);
  EXPECT_TRUE(value_of(measure_box({})).box.empty());
}

}}  // namespace tessera::test
