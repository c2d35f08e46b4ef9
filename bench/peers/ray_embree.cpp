// The rays by Embree alone, one ray per call: the surface's facets as triangles and as Embree's grids, and the control
// points as a Catmull-Clark mesh without boundary faces, which is the B-spline surface. Hits are those of facets, in
// float.

#include <embree3/rtcore.h>

#include <cmath>
#include <limits>
#include <memory>

#include "peers/interleaved.h"
#include "peers/ray_task.h"
#include "support/synthetic_sets.h"
#include "tessera/evaluate.h"

namespace tessera::bench { namespace {

/// A scene of one geometry, and the rays.
class Casting {
 public:
  Casting(const RayTask& task, RTCGeometryType type)
      : task_(task),
        device_(rtcNewDevice("threads=1")),
        geometry_(rtcNewGeometry(device_, type)),
        rays_(task.camera.rays()) {}
  virtual ~Casting() {
    rtcReleaseScene(scene_);
    rtcReleaseGeometry(geometry_);
    rtcReleaseDevice(device_);
  }
  Casting(const Casting&) = delete;
  Casting& operator=(const Casting&) = delete;

  void build() {
    rtcCommitGeometry(geometry_);
    scene_ = rtcNewScene(device_);
    rtcAttachGeometry(scene_, geometry_);
    rtcCommitScene(scene_);
    if (rtcGetDeviceError(device_) != RTC_ERROR_NONE) throw std::runtime_error("Embree: the scene can't be built");
  }
  double run() {
    for (std::size_t k = 0; k < rays_.size(); ++k) rays_[k] = ray(task_.camera.ray(k));
    return seconds_of([&] {
      RTCIntersectContext context;
      rtcInitIntersectContext(&context);
      context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
      for (RTCRayHit& r : rays_) rtcIntersect1(scene_, &context, &r);
    });
  }
  double t(std::size_t k) const {
    return rays_[k].hit.geomID == RTC_INVALID_GEOMETRY_ID ? std::numeric_limits<double>::infinity()
                                                          : double{rays_[k].ray.tfar};
  }

 protected:
  template <class T>
  T* buffer(RTCBufferType type, RTCFormat format, std::size_t count, std::size_t stride = sizeof(T)) {
    return static_cast<T*>(rtcSetNewGeometryBuffer(geometry_, type, 0, format, stride, count));
  }
  const RayTask& task_;
  RTCDevice device_;
  RTCGeometry geometry_;

 private:
  static RTCRayHit ray(const Ray& r) {
    RTCRayHit out{};
    out.ray.org_x = static_cast<float>(r.origin.x), out.ray.dir_x = static_cast<float>(r.direction.x);
    out.ray.org_y = static_cast<float>(r.origin.y), out.ray.dir_y = static_cast<float>(r.direction.y);
    out.ray.org_z = static_cast<float>(r.origin.z), out.ray.dir_z = static_cast<float>(r.direction.z);
    out.ray.tfar = std::numeric_limits<float>::infinity();
    out.ray.mask = ~0u;
    out.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    return out;
  }

  RTCScene scene_ = nullptr;
  std::vector<RTCRayHit> rays_;
};

/// Points of the surface, rate + 1 in both directions of every patch.
std::vector<Vec3> facet_points(const RayTask& task) {
  std::vector<Vec3> points;
  for (std::size_t patch = 0; patch < task.set.patch_count(); ++patch)
    for (int i = 0; i <= facets_per_side; ++i)
      for (int j = 0; j <= facets_per_side; ++j)
        points.push_back(
            evaluate_jet(task.set.patch(patch), 1.0 * i / facets_per_side, 1.0 * j / facets_per_side).position);
  return points;
}
void put(const std::vector<Vec3>& points, float* out) {
  for (const Vec3& p : points)
    for (const double x : {p.x, p.y, p.z}) *out++ = static_cast<float>(x);
}

class Triangles : public Casting {
 public:
  explicit Triangles(const RayTask& task) : Casting(task, RTC_GEOMETRY_TYPE_TRIANGLE) {
    const auto points = facet_points(task);
    put(points, buffer<float>(RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, points.size(), 12));
    constexpr unsigned n = facets_per_side, row = n + 1;
    const std::size_t triangles = task.set.patch_count() * 2 * n * n;
    auto* out = buffer<unsigned>(RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, triangles, 12);
    for (unsigned patch = 0; patch < task.set.patch_count(); ++patch)
      for (unsigned i = 0; i < n; ++i)
        for (unsigned j = 0; j < n; ++j) {
          const unsigned a = patch * row * row + i * row + j, b = a + row;
          for (const unsigned corner : {a, b, b + 1, a, b + 1, a + 1}) *out++ = corner;
        }
    build();
  }
};

class Grids : public Casting {
 public:
  explicit Grids(const RayTask& task) : Casting(task, RTC_GEOMETRY_TYPE_GRID) {
    const auto points = facet_points(task);
    put(points, buffer<float>(RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, points.size(), 12));
    constexpr unsigned row = facets_per_side + 1;
    auto* out = buffer<RTCGrid>(RTC_BUFFER_TYPE_GRID, RTC_FORMAT_GRID, task.set.patch_count());
    for (unsigned patch = 0; patch < task.set.patch_count(); ++patch) out[patch] = {patch * row * row, row, row, row};
    build();
  }
};

class Subdivision : public Casting {
 public:
  explicit Subdivision(const RayTask& task) : Casting(task, RTC_GEOMETRY_TYPE_SUBDIVISION) {
    const auto side = static_cast<unsigned>(task.side()), faces = side - 1;
    put(task.net, buffer<float>(RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, task.net.size(), 12));
    auto* sizes = buffer<unsigned>(RTC_BUFFER_TYPE_FACE, RTC_FORMAT_UINT, std::size_t{faces} * faces);
    auto* corners = buffer<unsigned>(RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT, std::size_t{4} * faces * faces);
    auto* levels = buffer<float>(RTC_BUFFER_TYPE_LEVEL, RTC_FORMAT_FLOAT, std::size_t{4} * faces * faces);
    for (unsigned i = 0; i < faces; ++i)
      for (unsigned j = 0; j < faces; ++j) {
        *sizes++ = 4;
        for (const unsigned corner : {i * side + j, (i + 1) * side + j, (i + 1) * side + j + 1, i * side + j + 1}) {
          *corners++ = corner;
          *levels++ = facets_per_side;
        }
      }
    rtcSetGeometrySubdivisionMode(geometry_, 0, RTC_SUBDIVISION_MODE_NO_BOUNDARY);
    build();
  }
};

template <class Scene>
RayRun run_of(const RayTask& task, const char* way) {
  const auto scene = std::make_shared<Scene>(task);
  return {"Embree " RTC_VERSION_STRING, way, 1, [=] { return scene->run(); },
          [=](std::size_t ray) { return scene->t(ray); }};
}

const bool registered = [] {
  ray_peers().push_back({"Embree", [](const RayTask& task) {
                           return std::vector<RayRun>{run_of<Triangles>(task, "triangles"),
                                                      run_of<Grids>(task, "grids"),
                                                      run_of<Subdivision>(task, "subdivision")};
                         }});
  return true;
}();

}}  // namespace tessera::bench
