// Compares grid mode, refined onto the surface, with Embree's robust grids of the same points: the same rays in one
// process by turns, so that the ratios of the times count; coherent rays also with grids in packets of 16. A sample of
// each case is checked against a ray caster that shares no code.

#include <benchmark/benchmark.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "rival.h"
#include "stopwatch.h"
#include "suite.h"
#include "support/reference_rays.h"
#include "tessera/ray_scene.h"
#include "timing.h"
#include "torus_rays.h"

namespace tessera::bench { namespace {

constexpr int cells = 12;  // per patch and direction

struct Scenes {
  TorusRays work{60, false};
  RayScene refined;
  Rival grids;

  Scenes() : refined(scene_of(work.set)), grids(Rival::grids(work.set, cells, available_isas().back())) {}
  static RayScene scene_of(const PatchSet& set) {
    RaySceneOptions options;
    options.mode = RayMode::grid;
    options.rate = cells;
    return test::value_of(RayScene::make(set, options));
  }
};

void closest(benchmark::State& state, const Scenes& scenes, const std::vector<Ray>& rays, int threads) {
  std::vector<Hit> hits(rays.size());
  std::vector<float> grids(rays.size());
  Stopwatch single, packets;
  const auto best = time_calls(
      state, threads, [&] { return scenes.refined.closest(rays, hits); },
      [&] {
        single.time(threads, [&] { scenes.grids.closest(rays, grids); });
        packets.time(threads, [&] { scenes.grids.closest_packets(rays, grids); });
      });
  if (!best) return;
  constexpr std::size_t sample = 256;
  std::size_t wrong = 0;
  for (std::size_t k = 0; k < sample; ++k) {
    const std::size_t ray = (k * rays.size() + rays.size() / 2) / sample;
    const test::ReferenceHit expected = test::reference_closest(scenes.work.patches, rays[ray]);
    const bool hit = hits[ray].kind == HitKind::hit;
    wrong += hit != expected.hit() || (hit && !(std::abs(hits[ray].t - expected.t) <= 1e-9));
  }
  // Facets lose silhouettes, where grazing rays go.
  if (wrong * 20 > sample)
    return state.SkipWithError(
        (std::to_string(wrong) + " of " + std::to_string(sample) + " answers are wrong").c_str());
  report_rates(state, *best, static_cast<double>(ray_count));
  state.counters["ns_per_ray"] = *best / static_cast<double>(ray_count) * 1e9;
  state.counters["of_grids"] = *best / single.best();
  state.counters["of_packets"] = *best / packets.best();
  state.counters["wrong_of_checked"] = static_cast<double>(wrong) / static_cast<double>(sample);
}

[[maybe_unused]] const bool registered = [] {
  for (const int threads : {1, 2}) {
    for (const char* kind : {"coherent", "incoherent", "grazing"}) {
      add_case({std::string("ray.grid.closest.") + kind, "torus3600", "3", std::to_string(ray_count), "-", threads},
               Part::full, [=](benchmark::State& state) {
                 static const Scenes scenes;
                 closest(state, scenes, scenes.work.rays.at(kind), threads);
               });
    }
  }
  return true;
}();

}}  // namespace tessera::bench
