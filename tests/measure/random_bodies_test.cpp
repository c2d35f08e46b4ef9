// Bounds hold for random bodies, as a much finer quadrature tells; and for patches that are hard to measure.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "measure/measure_bodies.h"

namespace tessera::test { namespace {

std::vector<Vec3> random_net(Random& random, int m, int n) {
  std::vector<Vec3> points;
  for (int i = 0; i <= m; ++i)
    for (int j = 0; j <= n; ++j)
      points.push_back(Vec3{double(i) / m, double(j) / n, 1} + uniform_vector(random, -0.15, 0.15));
  return points;
}

void expect_cone(const BezierPatch& patch, double share, const std::string& what) {
  const Vec3 apex{0.4, 0.5, -1};
  const BodyMeasures body = value_of(measure_enclosed(surfaces_of(cone_over(patch, apex))));
  const ReferenceCone fine = reference_cone(patch, apex, 24), finer = reference_cone(patch, apex, 48);
  const double sign = finer.volume < 0 ? -1 : 1;  // measures turn bodies outwards
  // The reference's own error, from its convergence.
  const double slack = 4 * std::abs(finer.volume - fine.volume) + 1e-13 * std::abs(finer.volume);
  EXPECT_LE(std::abs(body.volume.value - sign * finer.volume), body.volume.error + slack) << what;
  EXPECT_LE(body.volume.error, share * std::abs(finer.volume)) << what;
  const Vec3 centroid = apex + (1 / finer.volume) * finer.moment;
  const Vec3 rough = apex + (1 / fine.volume) * fine.moment;
  EXPECT_LE(max_abs(body.centroid.value - centroid), body.centroid.error + 4 * max_abs(centroid - rough) + 1e-13)
      << what;
  EXPECT_TRUE(body.proven);
}

TEST(RandomBodies, BoundsHoldForPolynomialAndRationalPatches) {
  Random random(11);
  for (const auto& [m, n] : {std::pair(3, 3), {2, 4}, {5, 3}, {1, 6}})
    for (int trial = 0; trial < 6; ++trial) {
      const std::vector<Vec3> points = random_net(random, m, n);
      const std::string what = std::to_string(m) + " x " + std::to_string(n) + ", " + std::to_string(trial);
      expect_cone(polynomial(m, n, points), 1e-8, what);
      std::vector<double> weights;
      for (std::size_t k = 0; k < points.size(); ++k) weights.push_back(std::pow(10, uniform(random, -0.7, 0.7)));
      expect_cone(rational(m, n, points, weights), 1e-8, what + " rational");
    }
}

TEST(RandomBodies, BoundsHoldForWeightsFarApart) {
  Random random(12);
  for (std::size_t trial = 0; trial < 4; ++trial) {
    const std::vector<Vec3> points = random_net(random, 2, 2);
    std::vector<double> weights(9, 1.0);
    weights[4] = 1e-9, weights[trial] = 1e-3;
    expect_cone(rational(2, 2, points, weights), 1e-5, "a light middle, " + std::to_string(trial));
    // A heavy middle pulls all to its point but the sides: up to a share of about 1e-8, the patch is the cones over
    // these, with all of the bend in layers as thin as 1e-9.
    weights[4] = 1e9;
    const BezierPatch heavy = rational(2, 2, points, weights);
    std::vector<BezierPatch> cones = cone_over(heavy, points[4]);
    cones.erase(cones.begin());
    const double truth = value_of(measure_surfaces(model_of(surfaces_of(cones)))).total.area.value;
    const Measured area = value_of(measure_surfaces(model_of(surfaces_of({heavy})), {.max_cells = 20000})).total.area;
    EXPECT_LE(std::abs(area.value - truth), area.error + 1e-6 * truth) << trial;
    EXPECT_LE(area.error, truth) << trial;
    // Volumes: the body is that of the cones in place of the patch, turned round.
    const Vec3 apex{0.4, 0.5, -1};
    std::vector<BezierPatch> body = cone_over(heavy, apex), flat = body;
    flat.erase(flat.begin());
    for (const BezierPatch& cone : cones) flat.push_back(value_of(transpose(cone)));
    const Measured volume = value_of(measure_enclosed(surfaces_of(body))).volume;
    const double limit = value_of(measure_enclosed(surfaces_of(flat))).volume.value;
    EXPECT_LE(std::abs(volume.value - limit), volume.error + 1e-6 * limit) << trial;
  }
}

TEST(RandomBodies, AreasAgreeWithAFinerQuadrature) {
  Random random(13);
  for (int trial = 0; trial < 12; ++trial) {
    std::vector<Vec3> points = random_net(random, 3, 3);
    const BezierPatch patch = polynomial(3, 3, points);
    const Measured area = value_of(measure_surfaces(model_of(surfaces_of({patch})))).total.area;
    double sums[2] = {0, 0};
    for (const int level : {0, 1}) {
      const int n = 200 << level;
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
          const SurfaceJet jet = evaluate_jet(patch, (i + 0.5) / n, (j + 0.5) / n);
          sums[level] += length(cross(jet.du, jet.dv)) / (n * n);
        }
    }
    const double extrapolated = sums[1] + (sums[1] - sums[0]) / 3;  // Richardson: midpoints converge quadratically
    EXPECT_NEAR(area.value, extrapolated, area.error + 1e-9 * extrapolated) << trial;
    EXPECT_LE(area.error, 1e-8 * area.value) << trial;
  }
}

TEST(RandomBodies, PatchesWithoutAreaHaveNone) {
  Random random(14);
  const Vec3 at = uniform_vector(random, -1, 1);
  const std::vector<BezierPatch> patches{
      polynomial(3, 3, std::vector<Vec3>(16, at)),                                            // a point
      polynomial(1, 1, {{0, 0, 0}, {1, 2, 3}, {0, 0, 0}, {1, 2, 3}}),                         // a line
      polynomial(2, 1, {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {1, 0, 1}, {0, 0, 0}, {0, 0, 1}})};  // there and back
  const AreaMeasures found = value_of(measure_surfaces(model_of(surfaces_of(patches))));
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(found.surfaces[k].area.value, 0) << k;
    EXPECT_LE(found.surfaces[k].area.error, 1e-13) << k;
  }
  EXPECT_TRUE(is_finite(found.total.centroid.value));
  // The last one covers x from 0 to 1/2 twice.
  EXPECT_NEAR(found.surfaces[2].area.value, 1, found.surfaces[2].area.error);
  EXPECT_LE(found.surfaces[2].area.error, 1e-6);
  const BodyMeasures flat = value_of(measure_enclosed(surfaces_of(patches)));
  EXPECT_LE(std::abs(flat.volume.value), flat.volume.error + 1e-15);
  EXPECT_TRUE(is_finite(flat.centroid.value) && std::isfinite(flat.inertia.error));
}

TEST(RandomBodies, PolesAndCusps) {
  // A disc whose rows meet in a point, as a cone of no height: the normal vanishes at the pole alone.
  std::vector<Vec3> points{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  const double w = std::sqrt(0.5);
  const BezierPatch quarter = rational(1, 2, points, {1, w, 1, 1, w, 1});
  const SurfaceMeasures found = value_of(measure_surfaces(model_of(surfaces_of({quarter})))).total;
  expect_measured(found.area, std::numbers::pi / 4, 1e-9, "quarter of a disc");
  expect_point(found.centroid, {4 / (3 * std::numbers::pi), 4 / (3 * std::numbers::pi), 0}, 1e-8, "quarter of a disc");
  // A cuspidal edge: (t^2, t^3) along u is a cusp in the middle, swept along v. Its length from t = 0 to 1/2 doubled.
  const std::vector<Vec3> cusp{{0.25, -0.125, 0},     {0.25, -0.125, 1},      {-0.25 / 3, 0.125, 0},
                               {-0.25 / 3, 0.125, 1}, {-0.25 / 3, -0.125, 0}, {-0.25 / 3, -0.125, 1},
                               {0.25, 0.125, 0},      {0.25, 0.125, 1}};
  const Measured area = value_of(measure_surfaces(model_of(surfaces_of({polynomial(3, 1, cusp)})))).total.area;
  const double half = (std::pow(4 + 9 * 0.25, 1.5) - 8) / 27;
  EXPECT_NEAR(area.value, 2 * half, area.error + 1e-15);
  EXPECT_LE(area.error, 1e-6 * half);
}

TEST(RandomBodies, FewCellsGiveWiderBoundsThatHold) {
  const std::vector<BezierPatch> ball = sphere();
  const double truth = 4 * std::numbers::pi;
  double before = 1e300;
  for (const std::size_t cells : {1u, 4u, 16u, 64u, 256u, 1024u}) {
    const Measured area = value_of(measure_surfaces(model_of(surfaces_of(ball)), {.max_cells = cells})).total.area;
    EXPECT_LE(std::abs(area.value - truth), area.error) << cells;
    EXPECT_LE(area.error, before) << cells;
    before = area.error;
  }
  EXPECT_LE(before, 1e-8);
  for (const double accuracy : {1e-2, 1e-4, 1e-8, 1e-12}) {
    const Measured area = value_of(measure_surfaces(model_of(surfaces_of(ball)), {.accuracy = accuracy})).total.area;
    EXPECT_LE(std::abs(area.value - truth), area.error) << accuracy;
    EXPECT_LE(area.error, 20 * accuracy * truth) << accuracy;
  }
}

}}  // namespace tessera::test
