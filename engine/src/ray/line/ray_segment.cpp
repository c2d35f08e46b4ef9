#include "ray/line/ray_segment.h"
#include "base/infinity.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr double segment_rounding = 4 * std::numeric_limits<double>::epsilon();  // of an s, by its distance

/// Narrows [near, far] to where origin + s * direction lies in [lower, upper].
void clip(double origin, double direction, double lower, double upper, double& near, double& far) {
  constexpr double parallel = 1e-300;  // of a unit vector: the reciprocal is finite
  if (std::abs(direction) < parallel) {
    if (origin < lower || origin > upper) far = -infinity;
    return;
  }
  const double inverse = 1 / direction;
  double enter = (lower - origin) * inverse, leave = (upper - origin) * inverse;
  if (enter > leave) std::swap(enter, leave);
  near = std::max(near, enter);
  far = std::min(far, leave);
}

}  // namespace

bool is_valid(const Ray& ray) {
  // Written so that NaN fails.
  return max_abs(ray.origin) <= max_ray_component && max_abs(ray.direction) <= max_ray_component &&
         is_finite(ray.origin) && is_finite(ray.direction) && max_abs(ray.direction) > 0 && ray.tnear >= 0 &&
         ray.tnear <= ray.tfar && ray.spawn_offset >= 0 && ray.spawn_offset <= max_ray_component;
}

FacetRay RaySegment::facet_ray(float s_near) const {
  FacetRay ray;
  ray.origin = {static_cast<float>(start.x), static_cast<float>(start.y), static_cast<float>(start.z)};
  ray.direction = {static_cast<float>(direction.x), static_cast<float>(direction.y), static_cast<float>(direction.z)};
  ray.tnear = s_near;
  ray.tfar = std::nextafter(static_cast<float>(reach), std::numeric_limits<float>::max());
  return ray;
}

// The line enters the box at most `reach` behind `offset`.
double RaySegment::rounding() const {
  return segment_rounding * (max_abs(start - offset * direction) + std::abs(offset) + reach);
}

RaySegment cut(const Ray& ray, const Vec3& origin, const Box3& box, double margin) {
  RaySegment out;
  // Divides first by the largest component, so that neither tiny nor huge directions overflow or underflow.
  const double largest = max_abs(ray.direction);
  const Vec3 scaled{ray.direction.x / largest, ray.direction.y / largest, ray.direction.z / largest};
  const double stretch = length(scaled);
  out.direction = (1 / stretch) * scaled;
  out.scale = largest * stretch;

  const Vec3 from = ray.origin - origin, d = out.direction;
  double near = ray.tnear * out.scale, far = ray.tfar * out.scale;
  clip(from.x, d.x, box.lower.x, box.upper.x, near, far);
  clip(from.y, d.y, box.lower.y, box.upper.y, near, far);
  clip(from.z, d.z, box.lower.z, box.upper.z, near, far);
  // A far origin rounds by its distance; a miss of the box by that much counts as a hit.
  const double slack = margin + segment_rounding * (max_abs(from) + std::abs(near));
  if (!std::isfinite(near) || !(near <= far + slack)) return out;
  out.offset = near - slack;
  out.start = from + out.offset * d;
  // A set so far away rounds by more than Embree accepts, and hits could not be told apart.
  if (!(max_abs(out.start) <= max_ray_component)) return out;
  out.reach = std::max(far - near, 0.0) + 2 * slack;
  out.empty = false;
  return out;
}

}}  // namespace tessera::abi_0_1
