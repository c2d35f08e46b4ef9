// Patches in the program's own Embree scene: two instances of a dome, one of them mirrored, beside a floor of
// triangles. A filter removes every other field of a chequerboard from the dome, for shadows too. The picture,
// domes.pgm, is checked pixel by pixel against the dome's equation.

#include <tessera/ray_embree.h>

#include <array>
#include <cmath>
#include <fstream>
#include <vector>

#include "dome.h"

namespace {

using tessera::Vec3;

constexpr int width = 240, height = 160;
constexpr double floor_height = -0.5;
constexpr unsigned visible = 1, casts_shadow = 2;  // masks

/// Scales x, y and z each by a factor, then translates.
struct Placement {
  Vec3 scale, shift;
  Vec3 back(const Vec3& p) const {
    return {(p.x - shift.x) / scale.x, (p.y - shift.y) / scale.y, (p.z - shift.z) / scale.z};
  }
  Vec3 back_vector(const Vec3& d) const { return {d.x / scale.x, d.y / scale.y, d.z / scale.z}; }
};
constexpr std::array<Placement, 2> placements{{{{1, 1.5, 1}, {-1.4, 0, 0}}, {{-0.8, 1, 1.4}, {1.3, 0.2, 0.1}}}};

bool is_hole(double u, double v) {
  return (static_cast<int>(std::floor(6 * u)) + static_cast<int>(std::floor(6 * v))) % 2 != 0;
}

void leave_holes(const RTCFilterFunctionNArguments* arguments) {
  for (unsigned k = 0; k < arguments->N; ++k) {
    if (arguments->valid[k] == -1 &&
        is_hole(RTCHitN_u(arguments->hit, arguments->N, k), RTCHitN_v(arguments->hit, arguments->N, k)))
      arguments->valid[k] = 0;
  }
}

RTCScene make_dome_scene(RTCDevice device, const tessera::RayScene& dome) {
  const RTCScene scene = rtcNewScene(device);
  rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
  const RTCGeometry geometry = value_of(tessera::make_embree_geometry(dome, device));
  rtcSetGeometryIntersectFilterFunction(geometry, leave_holes);
  rtcSetGeometryOccludedFilterFunction(geometry, leave_holes);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene);
  return scene;
}

void add_instance(RTCDevice device, RTCScene to, RTCScene of, const Placement& placement, unsigned mask) {
  const RTCGeometry instance = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
  const auto narrow = [](double x) { return static_cast<float>(x); };
  const Vec3 &s = placement.scale, &t = placement.shift;
  const float map[12] = {narrow(s.x), 0, 0,           0,           narrow(s.y), 0,
                         0,           0, narrow(s.z), narrow(t.x), narrow(t.y), narrow(t.z)};
  rtcSetGeometryInstancedScene(instance, of);
  rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, map);
  rtcSetGeometryMask(instance, mask);
  rtcCommitGeometry(instance);
  rtcAttachGeometry(to, instance);
  rtcReleaseGeometry(instance);
}

void add_floor(RTCDevice device, RTCScene to) {
  const RTCGeometry floor = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  constexpr auto z = static_cast<float>(floor_height);
  const float corners[12] = {-50, -50, z, 50, -50, z, 50, 50, z, -50, 50, z};
  const unsigned triangles[6] = {0, 1, 2, 0, 2, 3};
  auto* const points =
      static_cast<float*>(rtcSetNewGeometryBuffer(floor, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, 4));
  auto* const indices =
      static_cast<unsigned*>(rtcSetNewGeometryBuffer(floor, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, 2));
  for (int k = 0; k < 12; ++k) points[k] = corners[k];
  for (int k = 0; k < 6; ++k) indices[k] = triangles[k];
  rtcCommitGeometry(floor);
  rtcAttachGeometry(to, floor);
  rtcReleaseGeometry(floor);
}

RTCRay make_ray(const Vec3& origin, const Vec3& direction, unsigned mask) {
  RTCRay ray{};
  ray.org_x = static_cast<float>(origin.x), ray.org_y = static_cast<float>(origin.y);
  ray.org_z = static_cast<float>(origin.z);
  ray.dir_x = static_cast<float>(direction.x), ray.dir_y = static_cast<float>(direction.y);
  ray.dir_z = static_cast<float>(direction.z);
  ray.tfar = INFINITY;
  ray.mask = mask;
  return ray;
}

/// The first thing that a ray hits: 0 and 1 the domes, 2 the floor, -1 nothing.
struct Met {
  int what = -1;
  double t = INFINITY;
  Vec3 normal;  ///< in the object's space
};

Met trace(RTCScene scene, const Vec3& origin, const Vec3& direction) {
  RTCRayHit query{};
  query.ray = make_ray(origin, direction, visible);
  query.hit.geomID = query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
#if RTC_VERSION_MAJOR < 4
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene, &context, &query);
#else
  rtcIntersect1(scene, &query, nullptr);
#endif
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
  const bool on_dome = query.hit.instID[0] != RTC_INVALID_GEOMETRY_ID;
  return {on_dome ? static_cast<int>(query.hit.instID[0]) : 2,
          query.ray.tfar,
          {query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z}};
}

bool is_in_shadow(RTCScene scene, const Vec3& from, const Vec3& to_light) {
  RTCRay ray = make_ray(from, to_light, casts_shadow);
  ray.tnear = 1e-3f;
#if RTC_VERSION_MAJOR < 4
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(scene, &context, &ray);
#else
  rtcOccluded1(scene, &ray, nullptr);
#endif
  return ray.tfar < 0;
}

/// The hit by equations: z = 1 - x^2 over the square, for each instance, and the floor.
Met expected(const Vec3& origin, const Vec3& direction) {
  Met met;
  const double floor_t = (floor_height - origin.z) / direction.z;
  if (floor_t > 0) met.what = 2, met.t = floor_t;
  for (std::size_t k = 0; k < placements.size(); ++k) {
    const Vec3 o = placements[k].back(origin), d = placements[k].back_vector(direction);
    const double a = d.x * d.x, b = 2 * o.x * d.x + d.z, c = o.x * o.x + o.z - 1, square = b * b - 4 * a * c;
    for (const double sign : {-1.0, 1.0}) {
      const double t = a > 1e-12 ? (-b + sign * std::sqrt(square)) / (2 * a) : -c / b;
      const double x = o.x + t * d.x, y = o.y + t * d.y;
      if (t > 0 && t < met.t && std::abs(x) <= 1 && std::abs(y) <= 1 && !is_hole((x + 1) / 2, (y + 1) / 2))
        met.what = static_cast<int>(k), met.t = t;
    }
  }
  return met;
}

unsigned char shade(RTCScene scene, const Vec3& point, const Met& met) {
  const Vec3 light = tessera::normalized({0.5, -0.6, 1});
  Vec3 normal{0, 0, 1};
  if (met.what < 2) {
    const Vec3& s = placements[static_cast<std::size_t>(met.what)].scale;
    normal = tessera::normalized({met.normal.x / s.x, met.normal.y / s.y, met.normal.z / s.z});
  }
  const double lit = is_in_shadow(scene, point, light) ? 0 : std::abs(dot(normal, light));
  return static_cast<unsigned char>(255 * std::sqrt(0.1 + 0.8 * lit));
}

}  // namespace

int main() {
  const tessera::PatchSet set = make_dome();
  const tessera::RayScene dome = value_of(tessera::RayScene::make(set));
  const RTCDevice device = rtcNewDevice(nullptr);
  const RTCScene domes = make_dome_scene(device, dome);
  const RTCScene scene = rtcNewScene(device);
  rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
  for (const Placement& placement : placements) add_instance(device, scene, domes, placement, visible | casts_shadow);
  add_floor(device, scene);
  rtcCommitScene(scene);

  const Vec3 eye{0.3, -6, 4.5}, forward = tessera::normalized(Vec3{0, 0.2, 0.2} - eye),
                                right = tessera::normalized(cross(forward, {0, 0, 1})), up = cross(right, forward);
  std::vector<unsigned char> pixels;
  int wrong = 0, seen[3] = {0, 0, 0};
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      const Vec3 direction = forward + (0.85 * ((column + 0.5) / width - 0.5)) * right +
                             (0.85 * height / width * (0.5 - (row + 0.5) / height)) * up;
      const Met met = trace(scene, eye, direction), wanted = expected(eye, direction);
      wrong += met.what != wanted.what || std::abs(met.t - wanted.t) > 1e-4;
      require(met.what >= 0, "a ray downwards misses the floor");
      ++seen[met.what];
      pixels.push_back(shade(scene, eye + met.t * direction, met));
    }
  }
  std::ofstream picture("domes.pgm", std::ios::binary);
  picture << "P5\n" << width << ' ' << height << "\n255\n";
  picture.write(reinterpret_cast<const char*>(pixels.data()), static_cast<std::streamsize>(pixels.size()));
  require(picture.good(), "the picture is not written");
  require(seen[0] > 1000 && seen[1] > 1000 && seen[2] > 1000, "something is not in the picture");
  // At borders of the chequerboard's fields, within a pixel's rounding, float and double may differ.
  require(wrong <= 8, "the picture is not that of the equations");
  rtcReleaseScene(scene);
  rtcReleaseScene(domes);
  rtcReleaseDevice(device);
  std::printf("embree_scene: %d x %d pixels, %d on the domes, %d decided otherwise by rounding\n", width, height,
              seen[0] + seen[1], wrong);
}
