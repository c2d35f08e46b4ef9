#pragma once
// An Embree scene as a program of the user has it, and rays into it.

#include <memory>
#include <string>
#include <type_traits>

#include "ray/embree/embree_api.h"
#include "ray_support.h"

namespace tessera::test {

inline constexpr unsigned nothing = RTC_INVALID_GEOMETRY_ID;

struct Release {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
  void operator()(RTCGeometry geometry) const { rtcReleaseGeometry(geometry); }
};
template <class Handle>
using Held = std::unique_ptr<std::remove_pointer_t<Handle>, Release>;

/// A device and a robust scene of it. `options`: further options of Embree, such as the instruction set.
struct World {
  explicit World(const std::string& options = {}) : device(rtcNewDevice(("start_threads=0" + options).c_str())) {}

  Held<RTCDevice> device;
  Held<RTCScene> scene = make_scene();

  Held<RTCScene> make_scene() const {
    Held<RTCScene> made(rtcNewScene(device.get()));
    rtcSetSceneFlags(made.get(), RTC_SCENE_FLAG_ROBUST);
    return made;
  }
};

inline RTCRayHit embree_ray(const Ray& ray) {
  RTCRayHit out{};
  const auto narrow = [](double x) { return static_cast<float>(x); };
  out.ray.org_x = narrow(ray.origin.x), out.ray.org_y = narrow(ray.origin.y), out.ray.org_z = narrow(ray.origin.z);
  out.ray.dir_x = narrow(ray.direction.x), out.ray.dir_y = narrow(ray.direction.y);
  out.ray.dir_z = narrow(ray.direction.z);
  out.ray.tnear = narrow(ray.tnear), out.ray.tfar = narrow(ray.tfar), out.ray.mask = ~0u;
  out.hit.geomID = out.hit.primID = out.hit.instID[0] = nothing;
  return out;
}

/// The ray as Embree has it.
inline Ray in_float(const Ray& ray) {
  const auto narrow = [](const Vec3& a) {
    return Vec3{static_cast<float>(a.x), static_cast<float>(a.y), static_cast<float>(a.z)};
  };
  Ray out = ray;
  out.origin = narrow(ray.origin), out.direction = narrow(ray.direction);
  return out;
}

inline RTCRayHit trace(RTCScene scene, const Ray& ray) {
  RTCRayHit out = embree_ray(ray);
  EmbreeContext context = embree_context();
  intersect(scene, context, Coherence::incoherent, out);
  return out;
}

inline bool is_occluded(RTCScene scene, const Ray& ray) {
  RTCRayHit out = embree_ray(ray);
  EmbreeContext context = embree_context();
  occluded(scene, context, Coherence::incoherent, out.ray);
  return out.ray.tfar < 0;
}

}  // namespace tessera::test
