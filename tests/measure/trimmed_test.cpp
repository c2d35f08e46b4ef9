// Areas of trimmed faces over many patches: what loops keep and what they cut away add up to all.

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "measure/measure_bodies.h"
#include "tessera/nurbs_surface.h"
#include "trim/trim_shapes.h"

namespace tessera::test { namespace {

/// A wavy B-spline surface of 4 x 3 patches over [0, 4] x [0, 3].
Surface wavy(Random& random, bool is_rational) {
  std::vector<double> u{0, 0, 0, 0, 1, 2, 3, 4, 4, 4, 4}, v{0, 0, 0, 1, 2, 3, 3, 3};
  std::vector<Vec3> points;
  std::vector<double> weights;
  for (int i = 0; i < 7; ++i)
    for (int j = 0; j < 5; ++j) {
      points.push_back(Vec3{i / 1.5, j * 0.75, 0} + uniform_vector(random, -0.2, 0.2));
      weights.push_back(uniform(random, 0.5, 2));
    }
  if (!is_rational) return value_of(BSplineSurface::polynomial(3, u, 2, v, points));
  return value_of(BSplineSurface::rational(3, u, 2, v, points, weights));
}

SurfaceMeasures measured(const Surface& surface, const std::vector<TrimLoop>& loops) {
  ModelSurface face = placed_surface(surface);
  face.trims = loops;
  return value_of(measure_surfaces(model_of({face}))).surfaces[0];
}

TrimLoop as_hole(TrimLoop loop) {
  loop.hole = true;
  return loop;
}

/// The area over a triangle of the parameters, by the midpoint rule of a square that is mapped to it.
double reference_area(const Surface& surface, const std::vector<ParameterPoint>& corners, int n) {
  const ModelSurface face = placed_surface(surface);
  const auto &a = corners[0], &b = corners[1], &c = corners[2];
  const double twice = std::abs((b.u - a.u) * (c.v - a.v) - (b.v - a.v) * (c.u - a.u));
  double sum = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double s = (i + 0.5) / n, t = (j + 0.5) / n;
      const double u = a.u + s * (b.u - a.u + t * (c.u - b.u)), v = a.v + s * (b.v - a.v + t * (c.v - b.v));
      const SurfaceJet jet = value_of(evaluate_jet(face, u, v));
      sum += s * twice / (n * n) * length(cross(jet.du, jet.dv));
    }
  return sum;
}

TEST(TrimmedAreas, PartsAddUpToTheWhole) {
  Random random(21);
  for (int trial = 0; trial < 12; ++trial) {
    const Surface surface = wavy(random, trial % 2 != 0);
    const SurfaceMeasures whole = measured(surface, {});
    const auto at = [&] { return ParameterPoint{uniform(random, 0.05, 3.95), uniform(random, 0.05, 2.95)}; };
    TrimLoop loop = polygon({at(), at(), at()});
    if (trial % 3 == 1) loop = ellipse({2, 1.5}, uniform(random, 0.3, 1.9), uniform(random, 0.3, 1.4));
    if (trial % 3 == 2) loop = rectangle(1, uniform(random, 1.5, 4), uniform(random, 0, 1), 2);  // along patch borders
    const SurfaceMeasures inside = measured(surface, {loop}), outside = measured(surface, {as_hole(loop)});
    const double sum = inside.area.value + outside.area.value;
    const double bound = inside.area.error + outside.area.error + whole.area.error;
    EXPECT_LE(std::abs(sum - whole.area.value), bound) << trial;
    EXPECT_LE(bound, 1e-7 * whole.area.value) << trial;
    EXPECT_TRUE(inside.proven && outside.proven) << trial;
    // So do the moments.
    const Vec3 moment = inside.area.value * inside.centroid.value + outside.area.value * outside.centroid.value;
    EXPECT_LE(max_abs((1 / sum) * moment - whole.centroid.value), 1e-7) << trial;
  }
}

TEST(TrimmedAreas, AgreeWithAFinerQuadrature) {
  Random random(22);
  for (int trial = 0; trial < 6; ++trial) {
    const Surface surface = wavy(random, trial % 2 != 0);
    const std::vector<ParameterPoint> corners{{uniform(random, 0, 1), uniform(random, 0, 1)},
                                              {uniform(random, 3, 4), uniform(random, 0, 1)},
                                              {uniform(random, 1, 3), uniform(random, 2, 3)}};
    const Measured area = measured(surface, {polygon(corners)}).area;
    const double coarse = reference_area(surface, corners, 200), fine = reference_area(surface, corners, 400);
    const double extrapolated = fine + (fine - coarse) / 3;
    EXPECT_NEAR(area.value, extrapolated, area.error + 0.5 * std::abs(fine - coarse)) << trial;
    EXPECT_LE(area.error, 1e-7 * area.value) << trial;
  }
}

TEST(TrimmedAreas, ManyHolesAndIslands) {
  // A plate of side 1 with 20 x 20 holes, each with an island.
  std::vector<TrimLoop> loops{rectangle(0, 1, 0, 1)};
  constexpr int n = 20;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const ParameterPoint at{(i + 0.5) / n, (j + 0.5) / n};
      loops.push_back(circle(at, 0.4 / n, true));
      loops.push_back(circle(at, 0.2 / n));
    }
  const BezierPatch plate = polynomial(1, 1, {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}});
  const SurfaceMeasures found = measured(plate, loops);
  expect_measured(found.area, 1 - std::numbers::pi * (0.16 - 0.04), 1e-7, "plate");
  EXPECT_TRUE(found.proven);
}

TEST(TrimmedAreas, LoopsThatCrossAreNotProven) {
  const BezierPatch plate = polynomial(1, 1, {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}});
  // Two discs of which the common part is cut away, as an odd number of loops must enclose a point.
  const SurfaceMeasures found = measured(plate, {circle({0.4, 0.5}, 0.2), circle({0.6, 0.5}, 0.2)});
  EXPECT_FALSE(found.proven);
  const double lens = 2 * 0.04 * std::acos(0.5) - 0.1 * std::sqrt(4 * 0.04 - 0.04);
  EXPECT_NEAR(found.area.value, 2 * (std::numbers::pi * 0.04 - lens), found.area.error);
}

}}  // namespace tessera::test
