#pragma once
// Surfaces whose winding numbers are tested, and closed formulas of solid angles.

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "base/impl_access.h"
#include "query/winding.h"
#include "support/random_patches.h"
#include "support/ray_classes.h"
#include "tessera/model.h"
#include "tessera/ray_scene.h"
#include "tessera/solid.h"

namespace tessera::test {

/// A set, its scene, the solid of them, and the solid's winding numbers along any direction.
struct WindingCase {
  explicit WindingCase(PatchSet of)
      : set(std::move(of)),
        scene(value_of(RayScene::make(set))),
        solid(value_of(Solid::make(scene))),
        winding(value_of(WindingNumbers::make(impl_of(std::as_const(scene)), {}))) {}
  explicit WindingCase(const std::vector<BezierPatch>& patches) : WindingCase(value_of(PatchSet::make(patches))) {}
  explicit WindingCase(const Model& model) : WindingCase(value_of(make_patch_set(model))) {}

  double at(const Vec3& point) const {
    double number = 0;
    EXPECT_TRUE(solid.winding_numbers({&point, 1}, {&number, 1}).ok());
    return number;
  }

  PatchSet set;
  RayScene scene;
  Solid solid;
  WindingNumbers winding;
};

/// The share of the sphere that a disc of radius 1 covers, seen from its axis at a distance.
inline double disc_share(double distance) { return 0.5 * (1 - distance / std::sqrt(1 + distance * distance)); }

/// The share that the rectangle [x0, x1] x [y0, y1] of the plane z = 0 covers, seen from p; negative from above.
inline double rectangle_share(const Vec3& p, double x0, double x1, double y0, double y1) {
  const auto corner = [&](double x, double y) {
    const double a = x - p.x, b = y - p.y, c = -p.z;
    return std::atan(a * b / (c * std::sqrt(a * a + b * b + c * c)));
  };
  return (corner(x1, y1) - corner(x0, y1) - corner(x1, y0) + corner(x0, y0)) / (4 * std::numbers::pi);
}

/// Expects that the number of a point is the same along all directions that are sure; returns the largest difference.
inline double spread_of(const WindingCase& of, const Vec3& point, Random& random, int directions) {
  double low = of.at(point), high = low;
  int sure = 0;
  for (int k = 0; k < directions; ++k) {
    AngleShare number;
    EXPECT_TRUE(of.winding.number_along(point, rays::unit_vector(random), number).ok());
    if (!number.is_sure) continue;
    ++sure;
    low = std::min(low, number.value), high = std::max(high, number.value);
  }
  EXPECT_GE(sure, directions * 3 / 4);
  return high - low;
}

/// Bilinear patches between corners.
inline BezierPatch quad(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return polynomial(1, 1, {a, b, c, d});
}
/// The patch with u and v exchanged, so that its normal is turned around.
inline BezierPatch turned(const BezierPatch& patch) {
  std::vector<Vec3> points;
  std::vector<double> weights;
  for (int j = 0; j <= patch.degree_v(); ++j)
    for (int i = 0; i <= patch.degree_u(); ++i)
      points.push_back(patch.point(i, j)), weights.push_back(patch.weight(i, j));
  const int u = patch.degree_v(), v = patch.degree_u();
  return value_of(patch.is_rational() ? BezierPatch::rational(u, v, points, weights)
                                      : BezierPatch::polynomial(u, v, points));
}

/// A full circle in the parameters of a surface, as a loop.
inline TrimLoop circle_loop(double x, double y, double radius, bool is_hole) {
  const Curve circle = value_of(make_nurbs_circle({.origin = {x, y, 0}}, radius));
  return {{circle}, is_hole, {}};
}

}  // namespace tessera::test
