// Compares scenes made of the library's own trees with those made of Embree's: the same rays, in one process by turns,
// so that the ratios of the times count. Both must give the same hits to the bit, but for those of facets, which Embree
// meets in float. Cases: closest and any hit of a camera's rays, which are traced in packets, and of random rays, which
// are traced one by one; the same in a scene of instances, and closest hits of facets; building and refitting.

#include <benchmark/benchmark.h>

#include <bit>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "ray/tree/ray_trees.h"
#include "stopwatch.h"
#include "suite.h"
#include "support/with_trees.h"
#include "tessera/ray_scene.h"
#include "timing.h"
#include "torus_rays.h"

namespace {

using namespace tessera;
using bench::ray_count;
using bench::Stopwatch;
using bench::TorusRays;
using test::WithTrees;

/// A torus, and eight of it side by side, turned.
struct TreeScenes {
  TreeScenes(const TorusRays& work, const RayTrees& trees) : torus(torus_of(work, trees)), eight(eight_of(trees)) {}

  RayScene torus, eight;

 private:
  static RayScene torus_of(const TorusRays& work, const RayTrees& trees) {
    const WithTrees with(trees);
    RaySceneOptions options;
    options.editable = true;
    return test::value_of(RayScene::make(work.set, options));
  }
  RayScene eight_of(const RayTrees& trees) const {
    const WithTrees with(trees);
    std::vector<RayInstance> instances;
    for (int k = 0; k < 8; ++k) {
      const Affine turned = Affine::rotated({1, 0.5, 0.25}, 0.4 * k) * Affine::scaled({0.4, 0.4, 0.4});
      instances.push_back({&torus, Affine::translated({k % 2 - 0.5, k / 2 % 2 - 0.5, k / 4 - 0.5}) * turned});
    }
    return test::value_of(RayScene::make(instances));
  }
};

RayScene facets_of(const TorusRays& work, const RayTrees& trees) {
  const WithTrees with(trees);
  return test::value_of(RayScene::make(work.set, RaySceneOptions{.mode = RayMode::grid}));
}

struct Both {
  TorusRays work{60, false};
  TreeScenes own{work, own_ray_trees()}, embree{work, preferred_ray_trees()};
  RayScene own_facets = facets_of(work, own_ray_trees()), embree_facets = facets_of(work, preferred_ray_trees());
};

const Both& both() {
  static const std::unique_ptr<Both> scenes = std::make_unique<Both>();
  return *scenes;
}

bool same(double a, double b) { return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b); }

bool same(const Hit& a, const Hit& b) {
  return a.kind == b.kind && (a.kind != HitKind::hit || (a.instance == b.instance && a.patch == b.patch &&
                                                         same(a.t, b.t) && same(a.u, b.u) && same(a.v, b.v)));
}

void report(benchmark::State& state, double own, double embree, double items) {
  bench::report_rates(state, own, items);
  state.counters["ns_each"] = own / items * 1e9;
  state.counters["ns_each_of_embree"] = embree / items * 1e9;
  state.counters["of_embree"] = own / embree;
}

/// Times closest hits, at most `max_differing` of which may differ.
void time_closest(benchmark::State& state, const RayScene& own, const RayScene& embree, const std::vector<Ray>& rays,
                  int threads, std::size_t max_differing) {
  std::vector<Hit> hits(rays.size()), expected(rays.size());
  Stopwatch watch;
  const auto best = bench::time_calls(
      state, threads, [&] { return own.closest(rays, hits); },
      [&] { watch.time(threads, [&] { (void)embree.closest(rays, expected); }); });
  if (!best) return;
  std::size_t differing = 0;
  for (std::size_t k = 0; k < rays.size(); ++k)
    differing += max_differing == 0 ? !same(hits[k], expected[k]) : hits[k].kind != expected[k].kind;
  if (differing > max_differing) return state.SkipWithError((std::to_string(differing) + " hits differ").c_str());
  report(state, *best, watch.best(), static_cast<double>(rays.size()));
}

void closest(benchmark::State& state, const RayScene& own, const RayScene& embree, const std::vector<Ray>& rays,
             int threads) {
  time_closest(state, own, embree, rays, threads, 0);
}

void occluded(benchmark::State& state, const RayScene& own, const RayScene& embree, const std::vector<Ray>& rays,
              int threads) {
  std::vector<std::uint8_t> found(rays.size()), expected(rays.size());
  Stopwatch watch;
  const auto best = bench::time_calls(
      state, threads, [&] { return own.occluded(rays, found); },
      [&] { watch.time(threads, [&] { (void)embree.occluded(rays, expected); }); });
  if (!best) return;
  if (found != expected) return state.SkipWithError("the answers differ");
  report(state, *best, watch.best(), static_cast<double>(rays.size()));
}

/// Builds the scenes anew, with the pieces of patches, which both make in the same way.
void build(benchmark::State& state, int threads) {
  TorusRays work(60, false);
  TreeScenes own(work, own_ray_trees()), embree(work, preferred_ray_trees());
  Stopwatch watch;
  const auto best = bench::time_calls(
      state, threads, [&] { return own.torus.rebuild(); },
      [&] { watch.time(threads, [&] { (void)embree.torus.rebuild(); }); });
  if (best) report(state, *best, watch.best(), static_cast<double>(work.patches.size()));
  state.counters["memory_of_embree"] =
      static_cast<double>(own.torus.memory_bytes()) / static_cast<double>(embree.torus.memory_bytes());
}

void refit(benchmark::State& state, int threads) {
  TorusRays work(60, false);
  TreeScenes own(work, own_ray_trees()), embree(work, preferred_ray_trees());
  Stopwatch watch;
  std::uint32_t patch = 0;
  const auto best = bench::time_calls(
      state, threads, [&] { return own.torus.refit(); },
      [&] {
        patch = (patch + 1) % static_cast<std::uint32_t>(work.patches.size());
        if (!work.set.set_control_points(patch, work.patches[patch].points()).ok()) std::abort();
        watch.time(threads, [&] { (void)embree.torus.refit(); });
      });
  if (best) report(state, *best, watch.best(), static_cast<double>(work.patches.size()));
}

using Cast = void (*)(benchmark::State&, const RayScene&, const RayScene&, const std::vector<Ray>&, int);

[[maybe_unused]] const bool registered = [] {
  const auto add = [](const std::string& operation, std::size_t size,
                      const std::function<void(benchmark::State&)>& run) {
    bench::add_case({operation, "torus3600", "3", std::to_string(size), "-", 1}, bench::Part::quick, run);
  };
  for (const char* kind : {"coherent", "incoherent"}) {
    add(std::string("ray.trees.grid.closest.") + kind, ray_count, [=](benchmark::State& state) {
      time_closest(state, both().own_facets, both().embree_facets, both().work.rays.at(kind), 1, ray_count / 1000);
    });
    for (const auto& [operation, cast] : {std::pair<std::string, Cast>{"closest.", closest}, {"occluded.", occluded}}) {
      add("ray.trees." + operation + kind, ray_count, [=, cast = cast](benchmark::State& state) {
        cast(state, both().own.torus, both().embree.torus, both().work.rays.at(kind), 1);
      });
      add("ray.trees.instances." + operation + kind, ray_count, [=, cast = cast](benchmark::State& state) {
        cast(state, both().own.eight, both().embree.eight, both().work.rays.at(kind), 1);
      });
    }
  }
  add("ray.trees.build", 3600, [](benchmark::State& state) { build(state, 1); });
  add("ray.trees.refit", 3600, [](benchmark::State& state) { refit(state, 1); });
  return true;
}();

}  // namespace
