#pragma once
// The test of one ray against triangles without gaps between these.

#include <cmath>
#include <cstddef>
#include <optional>

#include "ray/line/facet_ray.h"

namespace tessera { inline namespace abi_0_1 {

/// A point less the ray's origin, sheared so that the ray runs along z.
struct ShearedPoint {
  double x = 0, y = 0, z = 0;
};

/// A place on a triangle: shares of its second and third corner, and t of the ray.
struct TriangleHit {
  double t = 0, second = 0, third = 0;
};

/// Woop, Benthin, Wald, Watertight Ray/Triangle Intersection, JCGT 2 (2013), in double: a corner has the same numbers
/// in all its triangles, and a side gives them opposite ones, so that a ray through a side meets one of its triangles.
class FacetShear {
 public:
  explicit FacetShear(const FacetRay& ray) : ray_(ray) {
    const auto size = [&](std::size_t axis) { return std::abs(ray.direction[axis]); };
    z_ = size(0) >= size(1) && size(0) >= size(2) ? 0 : size(1) >= size(2) ? 1 : 2;
    x_ = (z_ + 1) % 3, y_ = (z_ + 2) % 3;
    scale_ = 1 / double{ray.direction[z_]};
    shear_x_ = double{ray.direction[x_]} * scale_, shear_y_ = double{ray.direction[y_]} * scale_;
  }

  ShearedPoint operator()(const float* point) const {
    const double x = double{point[x_]} - double{ray_.origin[x_]}, y = double{point[y_]} - double{ray_.origin[y_]};
    const double z = double{point[z_]} - double{ray_.origin[z_]};
    return {x - shear_x_ * z, y - shear_y_ * z, scale_ * z};
  }

  /// Returns where the ray meets a triangle between its ends, borders included; nothing if it lies in its plane.
  std::optional<TriangleHit> meet(const ShearedPoint& a, const ShearedPoint& b, const ShearedPoint& c) const {
    const double u = c.x * b.y - c.y * b.x, v = a.x * c.y - a.y * c.x, w = b.x * a.y - b.y * a.x;
    if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) return {};
    const double sum = u + v + w;
    if (sum == 0) return {};
    const double share = 1 / sum, t = (u * a.z + v * b.z + w * c.z) * share;
    const auto narrow = static_cast<float>(t);
    if (!(narrow >= ray_.tnear && narrow <= ray_.tfar)) return {};
    return TriangleHit{t, v * share, w * share};
  }

 private:
  const FacetRay& ray_;
  std::size_t x_, y_, z_;
  double scale_, shear_x_, shear_y_;
};

}}  // namespace tessera::abi_0_1
