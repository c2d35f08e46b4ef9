// Areas, volumes and moments of bodies whose true values are known in closed form.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "support/errors.h"
#include "support/quadrics.h"
#include "tessera/measures.h"
#include "trim/trim_shapes.h"

namespace tessera::test { namespace {

constexpr double pi = std::numbers::pi;

/// Expects that the truth lies within the error, and that the error is small.
void expect_measured(const Measured& found, double truth, double most, const std::string& what) {
  EXPECT_LE(std::abs(found.value - truth), found.error + 4e-16 * std::abs(truth)) << what << ' ' << found.value << ' ' << truth;
  EXPECT_LE(found.error, most * std::abs(truth)) << what;
}

ModelSurface placed(const Surface& surface, const Affine& map = {}) {
  ModelSurface of{"", surface};
  of.placement = map;
  return of;
}

Model model_of(const std::vector<ModelSurface>& surfaces) { return {"", surfaces}; }

QuadricPiece ellipsoid(double a, double b, double c) {
  return piece(quadric({1 / (a * a), 1 / (b * b), 1 / (c * c), 0, 0, 0, 0, 0, 0, -1}), {-pi, pi, -pi / 2, pi / 2});
}

TEST(ClosedForm, Spheres) {
  for (const double radius : {1e-6, 1.0, 3.0, 1e6})
    for (const double far : {0.0, 1e3}) {
      const Vec3 at = far * radius * Vec3{1, -2, 0.5};
      const std::vector<ModelSurface> ball{placed(ellipsoid(radius, radius, radius), Affine::translated(at))};
      const std::string what = std::to_string(radius) + " at " + std::to_string(far);
      const double share = far == 0 ? 2e-9 : 1e-8;
      const AreaMeasures area = value_of(measure_surfaces(model_of(ball)));
      expect_measured(area.total.area, 4 * pi * radius * radius, share, what);
      EXPECT_TRUE(area.total.proven);
      const BodyMeasures body = value_of(measure_enclosed(ball));
      const double volume = 4.0 / 3.0 * pi * std::pow(radius, 3);
      expect_measured(body.volume, volume, share, what);
      EXPECT_LE(max_abs(body.centroid.value - at), body.centroid.error) << what;
      EXPECT_LE(body.centroid.error, share * radius) << what;
      const double inertia = 0.4 * volume * radius * radius;
      for (const double entry : {body.inertia.xx, body.inertia.yy, body.inertia.zz, body.inertia.moments[0], body.inertia.moments[2]})
        expect_measured({entry, body.inertia.moments_error}, inertia, 1e-7, what);
      std::printf("%s: area error %.2e, volume error %.2e inertia %.2e (relative), true %.2e %.2e\n", what.c_str(), area.total.area.error / area.total.area.value, body.volume.error / volume, body.inertia.error/inertia,
       area.total.area.value / (4 * pi * radius * radius) - 1, body.volume.value / volume - 1);
    }
}

}}  // namespace tessera::test
