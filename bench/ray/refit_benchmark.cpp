// Exact scenes that follow edits. After some patches of a torus have moved, compares new pieces and a refitted BVH with
// a build of the same scene, by turns, and rays in a refitted scene with those in a new one.

#include <benchmark/benchmark.h>

#include <cmath>
#include <string>
#include <vector>

#include "stopwatch.h"
#include "suite.h"
#include "support/random_patches.h"
#include "support/torus.h"
#include "tessera/ray_scene.h"
#include "timing.h"

namespace {

using namespace tessera;

constexpr std::size_t side = 120;

/// A torus of 14,400 patches that move up and down, and its scene.
class Moving {
 public:
  Moving()
      : patches_(test::Torus(side).patches(false)),
        set_(test::value_of(PatchSet::make(patches_))),
        scene_(test::value_of(RayScene::make(set_, {.editable = true}))) {}

  /// Moves each `step`th patch, by 0 or 1/100 in turn.
  void edit(std::size_t step) {
    up_ = !up_;
    for (std::size_t k = 0; k < patches_.size(); k += step) {
      std::vector<Vec3> points(patches_[k].points().begin(), patches_[k].points().end());
      for (Vec3& p : points) p.z += up_ ? 0.01 : 0;
      (void)set_.set_control_points(k, points);
    }
  }
  const std::vector<BezierPatch>& patches() const { return patches_; }
  const PatchSet& set() const { return set_; }
  RayScene& scene() { return scene_; }

 private:
  std::vector<BezierPatch> patches_;
  PatchSet set_;
  RayScene scene_;
  bool up_ = false;
};

std::vector<Ray> camera_rays() {
  std::vector<Ray> rays;
  const Vec3 eye{1.3, -1.6, 1.5}, back = normalized(eye), right = normalized(cross({0, 0, 1}, back)),
                                  up = cross(back, right);
  for (int k = 0; k < 65536; ++k) {
    Ray ray;
    ray.origin = eye;
    ray.direction = -back + 1.1 * ((k % 256 + 0.5) / 256 - 0.5) * right + (0.5 - (k / 256 + 0.5) / 256) * up;
    rays.push_back(ray);
  }
  return rays;
}

void refit(benchmark::State& state, std::size_t step, int threads) {
  Moving moving;
  bench::Stopwatch builds;
  const auto best = bench::time_calls(
      state, threads, [&] { return moving.scene().refit(); },
      [&] {
        builds.time(threads, [&] { (void)moving.scene().rebuild(); });
        moving.edit(step);
      });
  if (!best) return;
  const RayScene fresh = test::value_of(RayScene::make(moving.set(), {.editable = true}));
  const std::vector<Ray> rays = camera_rays();
  std::vector<Hit> hits(rays.size()), expected(rays.size());
  bench::Stopwatch traced, traced_fresh;
  bool ok = true;
  for (int turn = 0; turn < 5; ++turn) {
    traced.time(threads, [&] { ok &= moving.scene().closest(rays, hits).ok(); });
    traced_fresh.time(threads, [&] { ok &= fresh.closest(rays, expected).ok(); });
  }
  std::size_t wrong = 0;
  for (std::size_t k = 0; k < rays.size(); ++k) {
    wrong += hits[k].kind != expected[k].kind ||
             (hits[k].kind == HitKind::hit && !(std::abs(hits[k].t - expected[k].t) < 1e-9));
  }
  if (!ok || wrong > 0) return state.SkipWithError("the refitted scene differs from one made anew");
  const std::size_t edited = (moving.patches().size() + step - 1) / step;
  bench::report_rates(state, *best, static_cast<double>(edited));
  state.counters["of_build"] = *best / builds.best();
  state.counters["rays_of_fresh"] = traced.best() / traced_fresh.best();
}

[[maybe_unused]] const bool registered = [] {
  for (const int threads : {1, 2}) {
    for (const auto& [what, step] :
         {std::pair<std::string, std::size_t>{"all", 1}, {"tenth", 10}, {"hundredth", 100}}) {
      bench::add_case({"ray.exact.refit." + what, "torus14400", "3", std::to_string(side * side), "-", threads},
                      bench::Part::full, [=, step = step](benchmark::State& state) { refit(state, step, threads); });
    }
  }
  return true;
}();

}  // namespace
