#pragma once
// Lines and boxes of a scene's own coordinates as Embree takes them. For the files of this floor that speak to Embree.

#include "ray/embree_api.h"
#include "ray/ray_line.h"
#include "tessera/vec.h"

namespace tessera {

// Rays in float: start and direction round by 2^-24 of at most 3.5 and over at most 4, a component by 5e-7. Boxes are
// larger by four times that on each side; Embree's own arithmetic is conservative in robust scenes.
inline constexpr float box_pad = 2e-6f;

inline RTCBounds padded(const Box3& box) {
  RTCBounds out{};
  out.lower_x = static_cast<float>(box.lower.x) - box_pad, out.upper_x = static_cast<float>(box.upper.x) + box_pad;
  out.lower_y = static_cast<float>(box.lower.y) - box_pad, out.upper_y = static_cast<float>(box.upper.y) + box_pad;
  out.lower_z = static_cast<float>(box.lower.z) - box_pad, out.upper_z = static_cast<float>(box.upper.z) + box_pad;
  return out;
}

/// Of a line that is not empty: from where it enters the scene's box to where it leaves it.
inline RTCRay embree_ray(const RayLine& line) {
  const auto narrow = [](double x) { return static_cast<float>(x); };
  const Vec3 start = line.start + line.enter * line.direction, &d = line.direction;
  RTCRay ray{};
  ray.org_x = narrow(start.x), ray.org_y = narrow(start.y), ray.org_z = narrow(start.z);
  ray.dir_x = narrow(d.x), ray.dir_y = narrow(d.y), ray.dir_z = narrow(d.z);
  ray.tfar = narrow(line.leave - line.enter) + box_pad;
  ray.mask = ~0u;
  return ray;
}

}  // namespace tessera
