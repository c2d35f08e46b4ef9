// Compares exact rays with Embree's robust triangles and its own subdivision geometry of the same patches: the same
// rays, one by one, in one process by turns, so that the ratios of the times count. Closest hits are also compared with
// triangles in packets of 16, which pay for coherent rays. Cases: closest hit and any hit; a camera's rays, random
// rays, rays that graze the surface; memory and build time. A sample of each case is checked against a ray caster that
// shares no code.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "rival.h"
#include "stopwatch.h"
#include "suite.h"
#include "support/reference_rays.h"
#include "tessera/ray_scene.h"
#include "timing.h"
#include "torus_rays.h"

namespace {

using namespace tessera;
using bench::ray_count;
using bench::Rival;
using bench::Stopwatch;
using bench::TorusRays;

constexpr int coarse = 12;                // cells per patch and direction
constexpr int fine = 54;                  // gives t to 1e-6 of the size on 3,600 patches
constexpr double share_differing = 0.02;  // largest share of rays for which facets and surface disagree on a hit

RayScene exact_scene(const TorusRays& work, Isa isa) {
  RaySceneOptions options;
  options.mode = RayMode::exact;
  options.isa = isa;
  return test::value_of(RayScene::make(work.set, options));
}

/// Shared by the cases of one set and instruction set. Only one exists at a time, because triangles take much memory.
struct Scenes {
  Scenes(const TorusRays& of, Isa on, int cells)
      : work(of), isa(on), quads(cells), exact(exact_scene(of, on)), triangles(Rival::triangles(of.set, cells, on)) {
    if (!of.is_rational) subdivision.emplace(Rival::subdivision(of.torus, cells, on));
  }
  const TorusRays& work;
  Isa isa;
  int quads;
  RayScene exact;
  Rival triangles;
  std::optional<Rival> subdivision;
};

struct Subject {
  std::string name;
  std::size_t side;
  bool rational;
};

const Scenes& scenes_of(const Subject& subject, Isa isa, int quads) {
  static std::unique_ptr<TorusRays> work;
  static std::unique_ptr<Scenes> scenes;
  static std::string which;
  if (which != subject.name) {
    scenes.reset();
    work = std::make_unique<TorusRays>(subject.side, subject.rational);
    which = subject.name;
  }
  if (!scenes || scenes->isa != isa || scenes->quads != quads) {
    scenes.reset();
    scenes = std::make_unique<Scenes>(*work, isa, quads);
  }
  return *scenes;
}

struct Times {
  Stopwatch triangles, packets, subdivision;
};

void report(benchmark::State& state, double best, const Scenes& scenes, const Times& times) {
  bench::report_rates(state, best, static_cast<double>(ray_count));
  state.counters["ns_per_ray"] = best / static_cast<double>(ray_count) * 1e9;
  state.counters["of_triangles"] = best / times.triangles.best();
  if (scenes.subdivision) state.counters["of_subdivision"] = best / times.subdivision.best();
}

/// Compares a sample of rays with the reference; `differ`: how many of all rays hit or miss otherwise in the triangles.
bool good(benchmark::State& state, const Scenes& scenes, const std::vector<Ray>& rays, std::size_t differ,
          const std::function<bool(std::size_t, const test::ReferenceHit&)>& is_right) {
  const std::size_t sample = 1'000'000 / scenes.work.patches.size();
  std::size_t wrong = 0;
  for (std::size_t k = 0; k < sample; ++k) {
    const std::size_t ray = (k * rays.size() + rays.size() / 2) / sample;
    wrong += !is_right(ray, test::reference_closest(scenes.work.patches, rays[ray]));
  }
  if (wrong * 50 <= sample && static_cast<double>(differ) <= share_differing * static_cast<double>(rays.size()))
    return true;
  state.SkipWithError((std::to_string(wrong) + " of " + std::to_string(sample) + " answers are wrong, " +
                       std::to_string(differ) + " are not the triangles'")
                          .c_str());
  return false;
}

/// The error of t that nine tenths of the hits stay below.
double error_of(const std::vector<float>& t, const std::vector<Hit>& hits) {
  std::vector<double> errors;
  for (std::size_t k = 0; k < t.size(); ++k) {
    if (hits[k].kind == HitKind::hit && std::isfinite(t[k])) errors.push_back(std::abs(t[k] - hits[k].t));
  }
  const auto nine_tenths = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() * 9 / 10);
  std::nth_element(errors.begin(), nine_tenths, errors.end());
  return *nine_tenths;
}

void closest(benchmark::State& state, const Scenes& scenes, const std::vector<Ray>& rays, int threads) {
  std::vector<Hit> hits(rays.size());
  std::vector<float> triangles(rays.size()), subdivision(rays.size());
  Times times;
  const auto best = bench::time_calls(
      state, threads, [&] { return scenes.exact.closest(rays, hits); },
      [&] {
        times.packets.time(threads, [&] { scenes.triangles.closest_packets(rays, triangles); });
        times.triangles.time(threads, [&] { scenes.triangles.closest(rays, triangles); });
        if (scenes.subdivision)
          times.subdivision.time(threads, [&] { scenes.subdivision->closest(rays, subdivision); });
      });
  if (!best) return;
  std::size_t differ = 0;
  for (std::size_t k = 0; k < rays.size(); ++k) differ += (hits[k].kind == HitKind::hit) != std::isfinite(triangles[k]);
  const bool right = good(state, scenes, rays, differ, [&](std::size_t k, const test::ReferenceHit& expected) {
    return expected.hit() == (hits[k].kind == HitKind::hit) &&
           (!expected.hit() || std::abs(hits[k].t - expected.t) <= 1e-9);
  });
  if (!right) return;
  report(state, *best, scenes, times);
  state.counters["of_packets"] = *best / times.packets.best();
  state.counters["t_error_of_triangles"] = error_of(triangles, hits) / scenes.work.set.box().diagonal();
}

void occluded(benchmark::State& state, const Scenes& scenes, const std::vector<Ray>& rays, int threads) {
  std::vector<std::uint8_t> found(rays.size()), triangles(rays.size()), subdivision(rays.size());
  Times times;
  const auto best = bench::time_calls(
      state, threads, [&] { return scenes.exact.occluded(rays, found); },
      [&] {
        times.triangles.time(threads, [&] { scenes.triangles.occluded(rays, triangles); });
        if (scenes.subdivision)
          times.subdivision.time(threads, [&] { scenes.subdivision->occluded(rays, subdivision); });
      });
  if (!best) return;
  std::size_t differ = 0;
  for (std::size_t k = 0; k < rays.size(); ++k) differ += (found[k] != 0) != (triangles[k] != 0);
  const bool right = good(state, scenes, rays, differ, [&](std::size_t k, const test::ReferenceHit& expected) {
    return expected.hit() == (found[k] != 0);
  });
  if (right) report(state, *best, scenes, times);
}

/// Builds pieces and BVH anew, and for comparison only the BVH of the triangles, whose vertices exist already.
void build(benchmark::State& state, const Scenes& shared, int threads) {
  const TorusRays& work = shared.work;
  RayScene exact = exact_scene(work, shared.isa);
  Rival triangles = Rival::triangles(work.set, shared.quads, shared.isa);
  Stopwatch watch;
  const auto best = bench::time_calls(
      state, threads, [&] { return exact.rebuild(); }, [&] { watch.time(threads, [&] { triangles.build(); }); });
  if (!best) return;
  const Ray& ray = work.rays.at("coherent")[ray_count / 2];
  if (exact.closest(ray).t != shared.exact.closest(ray).t) return state.SkipWithError("the rebuilt scene differs");
  bench::report_rates(state, *best, static_cast<double>(work.patches.size()));
  state.counters["of_triangles"] = *best / watch.best();
  state.counters["bytes_per_patch"] =
      static_cast<double>(exact.memory_bytes()) / static_cast<double>(work.patches.size());
  state.counters["memory_of_triangles"] =
      static_cast<double>(exact.memory_bytes()) / static_cast<double>(triangles.memory_bytes());
}

using Run = void (*)(benchmark::State&, const Scenes&, const std::vector<Ray>&, int);

void add(const Subject& subject, Isa isa, int threads, int quads, bench::Part part) {
  const std::string accuracy = quads == fine ? ".equal_accuracy" : "";
  const auto name_of = [&](const std::string& operation, const std::string& size) {
    return bench::CaseName{operation, subject.name,           subject.rational ? "3r" : "3",
                           size,      std::string(name(isa)), threads};
  };
  for (const char* kind : {"coherent", "incoherent", "grazing"}) {
    for (const auto& [operation, run] :
         {std::pair<std::string, Run>{"ray.exact.closest.", closest}, {"ray.exact.occluded.", occluded}}) {
      bench::add_case(name_of(operation + kind + accuracy, std::to_string(ray_count)), part,
                      [=, run = run](benchmark::State& state) {
                        const Scenes& scenes = scenes_of(subject, isa, quads);
                        run(state, scenes, scenes.work.rays.at(kind), threads);
                      });
    }
  }
  bench::add_case(name_of("ray.exact.build" + accuracy, std::to_string(subject.side * subject.side)), part,
                  [=](benchmark::State& state) { build(state, scenes_of(subject, isa, quads), threads); });
}

[[maybe_unused]] const bool registered = [] {
  const std::vector<Subject> subjects = {{"torus3600", 60, false}, {"torus3600", 60, true}, {"torus99856", 316, false}};
  for (Subject subject : subjects) {
    if (subject.rational) subject.name += "rational";
    for (const Isa isa : available_isas()) {
      if (isa == Isa::sse2) continue;
      for (const int threads : {1, 2}) {
        const bool quick = subject.name == "torus3600" && threads == 1;
        add(subject, isa, threads, coarse, quick ? bench::quick_on_fastest(isa) : bench::Part::full);
      }
    }
  }
  add(subjects[0], available_isas().back(), 1, fine, bench::Part::full);
  return true;
}();

}  // namespace
