#pragma once
// Lines and boxes of a scene's own coordinates in Embree's form, for the files of this floor that call Embree.

#include "ray/embree/embree_api.h"
#include "ray/line/ray_line.h"
#include "ray/tree/box_padding.h"
#include "tessera/geometry.h"

namespace tessera { inline namespace abi_0_1 {

inline RTCBounds padded(const Box3& box) {
  RTCBounds out{};
  out.lower_x = static_cast<float>(box.lower.x) - box_pad, out.upper_x = static_cast<float>(box.upper.x) + box_pad;
  out.lower_y = static_cast<float>(box.lower.y) - box_pad, out.upper_y = static_cast<float>(box.upper.y) + box_pad;
  out.lower_z = static_cast<float>(box.lower.z) - box_pad, out.upper_z = static_cast<float>(box.upper.z) + box_pad;
  return out;
}

/// Returns the ray of a line that is not empty, from where it enters the scene's box to where it leaves it.
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

/// Fills a packet of at most 16 rays, with their indices as ids; line(k) is line k of `count`.
template <class Line>
void set_packet(std::size_t count, const Line& line, RTCRayHit16& hit, int (&valid)[16]) {
  for (unsigned k = 0; k < 16; ++k) {
    valid[k] = k < count ? -1 : 0;
    const RTCRay ray = embree_ray(line(k < count ? k : 0));  // idle lanes repeat the first
    hit.ray.org_x[k] = ray.org_x, hit.ray.org_y[k] = ray.org_y, hit.ray.org_z[k] = ray.org_z;
    hit.ray.dir_x[k] = ray.dir_x, hit.ray.dir_y[k] = ray.dir_y, hit.ray.dir_z[k] = ray.dir_z;
    hit.ray.tnear[k] = 0, hit.ray.tfar[k] = ray.tfar;
    hit.ray.time[k] = 0, hit.ray.mask[k] = ~0u, hit.ray.id[k] = k, hit.ray.flags[k] = 0;
    hit.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID, hit.hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
  }
}

}}  // namespace tessera::abi_0_1
