// Exact rays at a surface of 1,600 patches with a hole in each, beside the same rays at the whole surface, in one
// process by turns: how much more a root costs where loops cut its patch. Hits are compared with those of the whole
// surface, and holes with their closed form.

#include <benchmark/benchmark.h>

#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "stopwatch.h"
#include "suite.h"
#include "support/synthetic_sets.h"
#include "tessera/model.h"
#include "tessera/nurbs_surface.h"
#include "tessera/ray_scene.h"
#include "timing.h"

namespace {

using namespace tessera;
using bench::Stopwatch;
using test::value_of;

constexpr int side = 40;  // patches
constexpr std::size_t ray_count = 65536;
constexpr double half_hole = 0.12;  // of a square hole that stands on its corner, in the middle of each patch

bool is_in_hole(double u, double v) {
  return std::abs(u - std::floor(u) - 0.5) + std::abs(v - std::floor(v) - 0.5) < half_hole;
}

TrimLoop polygon(std::vector<Vec3> corners, bool is_hole) {
  corners.push_back(corners.front());
  const std::vector<double> knots{0, 0, 1, 2, 3, 4, 4};
  return {{value_of(Curve::b_spline(1, corners, knots))}, is_hole};
}

/// A cubic spline over [0, side]^2 with waves, and its holes.
Model waves_with_holes() {
  std::vector<double> knots(4, 0.0);
  for (int k = 1; k < side; ++k) knots.push_back(k);
  knots.insert(knots.end(), 4, double{side});
  std::vector<Vec3> points;
  for (int i = 0; i < side + 3; ++i)
    for (int j = 0; j < side + 3; ++j) points.push_back({double(i), double(j), std::sin(0.7 * i) * std::cos(0.6 * j)});
  const double end = side, h = half_hole;
  std::vector<TrimLoop> loops{polygon({{0, 0, 0}, {end, 0, 0}, {end, end, 0}, {0, end, 0}}, false)};
  for (int a = 0; a < side; ++a)
    for (int b = 0; b < side; ++b) {
      const double u = a + 0.5, v = b + 0.5;
      loops.push_back(polygon({{u - h, v, 0}, {u, v - h, 0}, {u + h, v, 0}, {u, v + h, 0}}, true));
    }
  return {.name = {},
          .surfaces = {{.name = std::string("waves"),
                        .surface = value_of(BSplineSurface::polynomial(3, knots, 3, knots, points)),
                        .trims = std::move(loops)}}};
}

std::vector<Ray> rays_at(const Box3& box, bool are_coherent) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<Ray> rays;
  for (std::size_t k = 0; k < ray_count; ++k) {
    const double x = are_coherent ? (0.5 + static_cast<double>(k % 256)) / 256 : uniform(random);
    const double y = are_coherent ? (0.5 + static_cast<double>(k / 256)) / 256 : uniform(random);
    const Vec3 at{box.lower.x + x * (box.upper.x - box.lower.x), box.lower.y + y * (box.upper.y - box.lower.y), 0};
    const Vec3 eye = box.centre() + Vec3{0.1, 0.2, 50};
    Ray ray;
    ray.origin = are_coherent ? eye : at + Vec3{20 * uniform(random) - 10, 20 * uniform(random) - 10, 30};
    ray.direction = normalized(at - ray.origin);
    rays.push_back(ray);
  }
  return rays;
}

/// Shared by all cases of one instruction set.
struct Scenes {
  explicit Scenes(Isa on)
      : isa(on),
        model(waves_with_holes()),
        cut_set(value_of(make_patch_set(model))),
        whole_set(value_of(make_patch_set(model, {.trims = false}))),
        cut(value_of(RayScene::make(cut_set, RaySceneOptions{.isa = on}))),
        whole(value_of(RayScene::make(whole_set, RaySceneOptions{.isa = on}))) {}

  Isa isa;
  Model model;
  PatchSet cut_set, whole_set;
  RayScene cut, whole;
};

const Scenes& scenes_of(Isa isa) {
  static std::unique_ptr<Scenes> scenes;
  if (!scenes || scenes->isa != isa) {
    scenes.reset();
    scenes = std::make_unique<Scenes>(isa);
  }
  return *scenes;
}

/// The first hit that no hole swallows.
const Hit* expected_hit(const HitLists& all, std::size_t ray) {
  for (std::size_t k = all.first[ray]; k < all.first[ray + 1]; ++k)
    if (!is_in_hole(all.hits[k].u, all.hits[k].v)) return &all.hits[k];
  return nullptr;
}

/// Reports the time that cut patches take beyond whole ones, over the roots at which they were asked.
void report(benchmark::State& state, double cut, double whole, std::size_t roots) {
  bench::report_rates(state, cut, static_cast<double>(ray_count));
  state.counters["of_whole"] = cut / whole;
  state.counters["ns_more_per_root"] = 1e9 * (cut - whole) / static_cast<double>(roots);
}

void closest(benchmark::State& state, const Scenes& scenes, const std::vector<Ray>& rays) {
  std::vector<Hit> hits(rays.size()), of_whole(rays.size());
  Stopwatch whole;
  const auto best = bench::time_calls(
      state, 1, [&] { return scenes.cut.closest(rays, hits); },
      [&] { whole.time(1, [&] { (void)scenes.whole.closest(rays, of_whole); }); });
  if (!best) return;
  HitLists all;
  if (!scenes.whole.all(rays, all).ok()) return state.SkipWithError("the whole surface has no hits");
  std::size_t roots = 0;
  for (std::size_t k = 0; k < rays.size(); ++k) {
    const Hit* const expected = expected_hit(all, k);
    roots += of_whole[k].kind == HitKind::hit;
    if ((expected != nullptr) != (hits[k].kind == HitKind::hit) ||
        (expected != nullptr && std::abs(expected->t - hits[k].t) > 1e-9))
      return state.SkipWithError("a hit is not the first one outside of the holes");
  }
  report(state, *best, whole.best(), roots);
}

void occluded(benchmark::State& state, const Scenes& scenes, const std::vector<Ray>& rays) {
  std::vector<std::uint8_t> found(rays.size()), of_whole(rays.size());
  Stopwatch whole;
  const auto best = bench::time_calls(
      state, 1, [&] { return scenes.cut.occluded(rays, found); },
      [&] { whole.time(1, [&] { (void)scenes.whole.occluded(rays, of_whole); }); });
  if (!best) return;
  HitLists all;
  if (!scenes.whole.all(rays, all).ok()) return state.SkipWithError("the whole surface has no hits");
  std::size_t roots = 0;
  for (std::size_t k = 0; k < rays.size(); ++k) {
    roots += of_whole[k];
    if ((expected_hit(all, k) != nullptr) != (found[k] != 0))
      return state.SkipWithError("a ray is dark or lit where the holes say otherwise");
  }
  report(state, *best, whole.best(), roots);
}

[[maybe_unused]] const bool registered = [] {
  using Run = void (*)(benchmark::State&, const Scenes&, const std::vector<Ray>&);
  for (const Isa isa : available_isas()) {
    if (isa == Isa::sse2) continue;
    for (const bool are_coherent : {true, false}) {
      for (const auto& [operation, run] : {std::pair<std::string, Run>{"closest.", closest}, {"occluded.", occluded}}) {
        const std::string name = "ray.trimmed." + operation + (are_coherent ? "coherent" : "incoherent");
        bench::add_case({name, "waves1600", "3", std::to_string(ray_count), std::string(tessera::name(isa))},
                        bench::quick_on_fastest(isa), [=, run = run](benchmark::State& state) {
                          const Scenes& scenes = scenes_of(isa);
                          run(state, scenes, rays_at(scenes.cut.box(), are_coherent));
                        });
      }
    }
  }
  return true;
}();

}  // namespace
