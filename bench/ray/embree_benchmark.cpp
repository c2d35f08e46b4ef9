// Secondary rays of the user's own Embree scene, which holds patches and triangles. Rays that leave a patch carry its
// point as their origin. They are compared, by turns in one process, with the rays of a naive offset, which begin a
// little off the surface and lose what lies nearer; and with two scenes whose hits are merged: the ray scene for
// patches, by Ray::spawn_offset, and an Embree scene of the triangles alone.

#include <benchmark/benchmark.h>
#include <tbb/parallel_for.h>
#include <xmmintrin.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "stopwatch.h"
#include "suite.h"
#include "tessera/ray_embree.h"
#include "timing.h"
#include "torus_rays.h"

namespace {

using namespace tessera;

constexpr float naive_offset = 1e-4f;
constexpr std::size_t bunch = 512;  // rays per task

RTCRay embree_ray(const Vec3& from, const Vec3& direction) {
  RTCRay out{};
  const auto narrow = [](double x) { return static_cast<float>(x); };
  out.org_x = narrow(from.x), out.org_y = narrow(from.y), out.org_z = narrow(from.z);
  out.dir_x = narrow(direction.x), out.dir_y = narrow(direction.y), out.dir_z = narrow(direction.z);
  out.tfar = std::numeric_limits<float>::infinity(), out.mask = ~0u;
  return out;
}

RTCRayHit embree_query(const RTCRay& ray) {
  RTCRayHit out{};
  out.ray = ray;
  out.hit.geomID = out.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  return out;
}

/// A floor below the torus and a tent over a part of it.
RTCGeometry make_triangles(RTCDevice device) {
  const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  constexpr std::array<float, 21> points{-4,    -4,    -0.5f, 4,    -4,   -0.5f, 4,    4, -0.5f, -4,  4,
                                         -0.5f, -0.5f, -1.5f, 0.7f, 0.5f, -1.5f, 0.7f, 0, 0,     0.9f};
  constexpr std::array<unsigned, 9> corners{0, 1, 2, 0, 2, 3, 4, 5, 6};
  std::copy(
      points.begin(), points.end(),
      static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, 7)));
  std::copy(
      corners.begin(), corners.end(),
      static_cast<unsigned*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, 3)));
  rtcCommitGeometry(geometry);
  return geometry;
}

/// The points of a camera's hits on patches, each with a direction at random on the side that the camera sees.
struct Leaving {
  std::vector<EmbreeOrigin> origins;
  std::vector<RTCRay> rays;    ///< of Embree
  std::vector<Ray> in_double;  ///< of the ray scene
};

struct Scenes {
  Scenes() : work(60, false), scene(test::value_of(RayScene::make(work.set))) {
    const RTCGeometry geometry = make_triangles(device);
    triangles = rtcNewScene(device), both = rtcNewScene(device);
    for (const RTCScene to : {triangles, both}) {
      rtcSetSceneFlags(to, RTC_SCENE_FLAG_ROBUST);
      rtcAttachGeometryByID(to, geometry, 0);
    }
    patches = test::value_of(attach(scene, both, {.origins = true}));
    for (const RTCScene to : {triangles, both}) rtcCommitScene(to);
    rtcReleaseGeometry(geometry);
    leave();
  }
  ~Scenes() {
    rtcReleaseScene(triangles), rtcReleaseScene(both);
    rtcReleaseDevice(device);
  }
  Scenes(const Scenes&) = delete;
  Scenes& operator=(const Scenes&) = delete;

  bench::TorusRays work;
  RayScene scene;
  RTCDevice device = rtcNewDevice("start_threads=0,set_affinity=0");
  RTCScene triangles = nullptr, both = nullptr;
  unsigned patches = 0;  ///< their geometry
  Leaving leaving;

 private:
  void leave();
};

Vec3 in_ball(std::mt19937_64& random) {
  std::uniform_real_distribution<double> one(-1, 1);
  for (;;) {
    const Vec3 v{one(random), one(random), one(random)};
    if (dot(v, v) <= 1 && dot(v, v) > 1e-4) return v;
  }
}

void Scenes::leave() {
  std::mt19937_64 random(9);
  for (const Ray& ray : work.rays.at("coherent")) {
    RTCRayHit first = embree_query(embree_ray(ray.origin, ray.direction));
    EmbreeOriginContext context;
    rtcIntersect1(both, &context, &first);
    if (first.hit.geomID != patches) continue;
    const Hit hit = test::value_of(scene.resolve(first.hit.primID, double{first.hit.u}, double{first.hit.v}));
    const double side = dot(hit.normal, ray.direction) < 0 ? 1 : -1;
    const Vec3 direction = normalized(side * hit.normal + 0.999 * normalized(in_ball(random)));
    leaving.origins.emplace_back(first.hit);
    leaving.rays.push_back(embree_ray(hit.position, direction));
    const RTCRay& narrowed = leaving.rays.back();
    Ray& out = leaving.in_double.emplace_back();
    out.origin = hit.position, out.direction = {narrowed.dir_x, narrowed.dir_y, narrowed.dir_z};
    out.spawn_offset = scene.spawn_offset();
  }
}

template <class Each>
void for_rays(const Scenes& scenes, Each each) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, scenes.leaving.rays.size(), bunch), [&](const auto& range) {
    const unsigned saved = _mm_getcsr();
    _mm_setcsr(saved | 0x8040);  // as Embree recommends
    for (std::size_t k = range.begin(); k < range.end(); ++k) each(k);
    _mm_setcsr(saved);
  });
}

float closest(RTCScene scene, RTCIntersectContext& context, const RTCRay& ray) {
  RTCRayHit query = embree_query(ray);
  rtcIntersect1(scene, &context, &query);
  return query.ray.tfar;
}

float any(RTCScene scene, RTCIntersectContext& context, RTCRay ray) {
  rtcOccluded1(scene, &context, &ray);
  return ray.tfar;
}

template <class Traced>
void by_origins(const Scenes& scenes, Traced trace, std::vector<float>& t) {
  for_rays(scenes, [&](std::size_t k) {
    EmbreeOriginContext context(scenes.leaving.origins[k]);
    t[k] = trace(scenes.both, context, scenes.leaving.rays[k]);
  });
}

template <class Traced>
void by_offset(const Scenes& scenes, Traced trace, std::vector<float>& t) {
  for_rays(scenes, [&](std::size_t k) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRay ray = scenes.leaving.rays[k];
    ray.tnear = naive_offset;
    t[k] = trace(scenes.both, context, ray);
  });
}

template <class Traced>
void by_merging(const Scenes& scenes, bool closest_wanted, Traced trace, std::vector<float>& t) {
  for_rays(scenes, [&](std::size_t k) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    t[k] = trace(scenes.triangles, context, scenes.leaving.rays[k]);
    const Ray& ray = scenes.leaving.in_double[k];
    if (closest_wanted) {
      t[k] = std::min(t[k], static_cast<float>(scenes.scene.closest(ray).t));
    } else if (t[k] >= 0 && scenes.scene.occluded(ray) == HitKind::hit) {
      t[k] = -std::numeric_limits<float>::infinity();
    }
  });
}

void run(benchmark::State& state, const Scenes& scenes, bool closest_wanted, int threads) {
  const std::size_t count = scenes.leaving.rays.size();
  const auto trace = [=](RTCScene scene, RTCIntersectContext& context, const RTCRay& ray) {
    return closest_wanted ? closest(scene, context, ray) : any(scene, context, ray);
  };
  std::vector<float> t(count), offset(count), merged(count);
  bench::Stopwatch by_offset_time, by_merging_time;
  const auto best = bench::time_calls(
      state, threads,
      [&] {
        by_origins(scenes, trace, t);
        return Status();
      },
      [&] {
        by_offset_time.time(threads, [&] { by_offset(scenes, trace, offset); });
        by_merging_time.time(threads, [&] { by_merging(scenes, closest_wanted, trace, merged); });
      });
  if (!best) return;
  std::size_t wrong = 0;
  for (std::size_t k = 0; k < count; ++k) wrong += t[k] != merged[k];
  if (wrong > 0) return state.SkipWithError((std::to_string(wrong) + " answers are not those of two scenes").c_str());
  bench::report_rates(state, *best, static_cast<double>(count));
  state.counters["ns_per_ray"] = *best / static_cast<double>(count) * 1e9;
  state.counters["of_naive_offset"] = *best / by_offset_time.best();
  state.counters["of_two_scenes"] = *best / by_merging_time.best();
}

/// The size in a case's name is that of the camera's rays; those that hit patches leave them.
[[maybe_unused]] const bool registered = [] {
  for (const int threads : {1, 2}) {
    for (const bool closest_wanted : {true, false}) {
      const std::string operation = closest_wanted ? "ray.embree.secondary.closest" : "ray.embree.secondary.occluded";
      bench::add_case({operation, "torus3600", "3", std::to_string(bench::ray_count), "-", threads},
                      threads == 1 ? bench::Part::quick : bench::Part::full, [=](benchmark::State& state) {
                        static const std::unique_ptr<Scenes> scenes = std::make_unique<Scenes>();
                        run(state, *scenes, closest_wanted, threads);
                      });
    }
  }
  return true;
}();

}  // namespace
