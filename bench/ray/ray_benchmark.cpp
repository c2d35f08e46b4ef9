// Rays per second in grid mode: the teapot and 20,000 patches, a camera's rays and random rays, closest hit and any
// hit, one thread and all. Each run is checked against a ray caster that shares no code before its speed counts.

#include <benchmark/benchmark.h>

#include <cmath>
#include <random>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "sets.h"
#include "suite.h"
#include "support/reference_rays.h"
#include "support/synthetic_sets.h"
#include "tessera/ray_scene.h"
#include "timing.h"

namespace {

using namespace tessera;

constexpr int rate = 8;

struct Workload {
  const PatchSet& set;
  RayScene scene;
  std::vector<BezierPatch> patches;  ///< for the reference
  std::vector<Ray> camera, random;
  std::size_t checked = 0;  ///< rays compared with the reference
};

double uniform(std::mt19937_64& random, double from, double to) {
  return from + (to - from) * static_cast<double>(random() >> 11) * 0x1p-53;
}

Vec3 in_box(std::mt19937_64& random, const Box3& box) {
  const double x = uniform(random, box.lower.x, box.upper.x), y = uniform(random, box.lower.y, box.upper.y);
  return {x, y, uniform(random, box.lower.z, box.upper.z)};
}

/// side x side rays from one eye in rows of pixels, over the whole box.
std::vector<Ray> camera_rays(const Box3& box, int side) {
  const Vec3 back = normalized({0.4, -0.8, 0.6}), right = normalized({0.8, 0.4, 0}), up = cross(back, right);
  const Vec3 eye = box.centre() + 1.2 * box.diagonal() * back;
  std::vector<Ray> rays;
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      Ray ray;
      ray.origin = eye;
      ray.direction = -back + 0.8 * ((x + 0.5) / side - 0.5) * right - 0.8 * ((y + 0.5) / side - 0.5) * up;
      rays.push_back(ray);
    }
  }
  return rays;
}

/// Rays from anywhere in the box through any other point of it.
std::vector<Ray> random_rays(const Box3& box, std::size_t count) {
  std::mt19937_64 random(7);
  std::vector<Ray> rays(count);
  for (Ray& ray : rays) {
    ray.origin = in_box(random, box);
    ray.direction = in_box(random, box) - ray.origin;
  }
  return rays;
}

Workload make_workload(std::string_view name, std::size_t checked) {
  const PatchSet& set = bench::set_named(name);
  RaySceneOptions options;
  options.mode = RayMode::grid;
  options.rate = rate;
  Workload work{set,
                test::value_of(RayScene::make(set, options)),
                {},
                camera_rays(set.box(), 256),
                random_rays(set.box(), 65536),
                checked};
  for (std::size_t k = 0; k < set.patch_count(); ++k) work.patches.push_back(set.patch(k));
  return work;
}

const Workload& teapot() {
  static const Workload work = make_workload("teapot", 1000);
  return work;
}

const Workload& bicubic20000() {
  static const Workload work = make_workload("bicubic20000", 100);
  return work;
}

/// Counts rays of a sample whose answer differs from the reference's. Grid mode may lose a silhouette here and there.
struct Check {
  std::size_t wrong = 0, sample = 0;
  bool good() const { return wrong * 50 <= sample; }
};

template <class IsWrong>
Check check(const Workload& work, const std::vector<Ray>& rays, IsWrong is_wrong) {
  Check out;
  const std::size_t step = rays.size() / work.checked;
  for (std::size_t k = step / 2; k < rays.size(); k += step) {
    out.wrong += is_wrong(k, test::reference_closest(work.patches, rays[k]));
    ++out.sample;
  }
  return out;
}

void report(benchmark::State& state, double best, const Workload& work, const std::vector<Ray>& rays,
            const Check& checked) {
  if (!checked.good()) {
    state.SkipWithError(
        (std::to_string(checked.wrong) + " of " + std::to_string(checked.sample) + " answers are wrong").c_str());
    return;
  }
  bench::report_rates(state, best, static_cast<double>(rays.size()));
  state.counters["wrong_of_checked"] = static_cast<double>(checked.wrong) / static_cast<double>(checked.sample);
  state.counters["bytes_per_patch"] =
      static_cast<double>(work.scene.memory_bytes()) / static_cast<double>(work.patches.size());
}

void closest(benchmark::State& state, const Workload& work, const std::vector<Ray>& rays, int threads) {
  std::vector<Hit> hits(rays.size());
  const auto best = bench::time_calls(state, threads, [&] { return work.scene.closest(rays, hits); });
  if (!best) return;
  const double tolerance = 1e-9 * work.set.box().diagonal();
  const Check checked = check(work, rays, [&](std::size_t k, const test::ReferenceHit& expected) {
    const bool hit = hits[k].kind == HitKind::hit;
    return hit != expected.hit() ||
           (hit && !(std::abs(hits[k].t - expected.t) * length(rays[k].direction) <= tolerance));
  });
  report(state, *best, work, rays, checked);
}

void occluded(benchmark::State& state, const Workload& work, const std::vector<Ray>& rays, int threads) {
  std::vector<std::uint8_t> occluded(rays.size());
  const auto best = bench::time_calls(state, threads, [&] { return work.scene.occluded(rays, occluded); });
  if (!best) return;
  const Check checked = check(work, rays, [&](std::size_t k, const test::ReferenceHit& expected) {
    return (occluded[k] != 0) != expected.hit();
  });
  report(state, *best, work, rays, checked);
}

/// Builds grids and BVH anew.
void refit(benchmark::State& state, const Workload& work, const std::vector<Ray>& rays, int threads) {
  RaySceneOptions options;
  options.mode = RayMode::grid;
  options.rate = rate;
  RayScene scene = test::value_of(RayScene::make(work.set, options));
  const auto best = bench::time_calls(state, threads, [&] { return scene.rebuild(); });
  if (!best) return;
  const Ray& ray = rays[rays.size() / 2 + 128];  // in the middle of the picture
  const Hit hit = scene.closest(ray);
  if (hit.kind != HitKind::hit || hit.t != work.scene.closest(ray).t)
    return state.SkipWithError("the refitted scene differs");
  bench::report_rates(state, *best, static_cast<double>(work.patches.size()));
}

using Run = void (*)(benchmark::State&, const Workload&, const std::vector<Ray>&, int);

/// The workloads are built on first use: a filter that leaves them out avoids their cost.
void add(const char* operation, const char* surface, const std::string& size, Run run, const Workload& (*work)(),
         std::vector<Ray> Workload::*rays) {
  const auto all = static_cast<int>(std::thread::hardware_concurrency());
  for (const int threads : {1, all}) {
    bench::add_case({operation, surface, "3", size, "-", threads},
                    threads == 1 ? bench::Part::quick : bench::Part::full,
                    [=](benchmark::State& state) { run(state, work(), work().*rays, threads); });
    if (all <= 1) break;
  }
}

[[maybe_unused]] const bool registered = [] {
  add("ray.closest.camera", "teapot", "65536", closest, teapot, &Workload::camera);
  add("ray.closest.random", "teapot", "65536", closest, teapot, &Workload::random);
  add("ray.closest.camera", "bicubic20000", "65536", closest, bicubic20000, &Workload::camera);
  add("ray.closest.random", "bicubic20000", "65536", closest, bicubic20000, &Workload::random);
  add("ray.occluded.camera", "teapot", "65536", occluded, teapot, &Workload::camera);
  add("ray.occluded.random", "teapot", "65536", occluded, teapot, &Workload::random);
  add("ray.occluded.camera", "bicubic20000", "65536", occluded, bicubic20000, &Workload::camera);
  add("ray.occluded.random", "bicubic20000", "65536", occluded, bicubic20000, &Workload::random);
  add("ray.refit", "teapot", "rate8", refit, teapot, &Workload::camera);
  add("ray.refit", "bicubic20000", "rate8", refit, bicubic20000, &Workload::camera);
  return true;
}();

}  // namespace
