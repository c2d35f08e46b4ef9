// Compares batches of rays in arrays of float with the same rays as records in double, in one process by turns: closest
// hits by requested results, occlusion, a filter, and instances. Each is checked against the hits of the records, bit
// for bit.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "stopwatch.h"
#include "suite.h"
#include "tessera/ray_scene.h"
#include "timing.h"
#include "torus_rays.h"

namespace {

using namespace tessera;
using bench::ray_count;
using bench::Stopwatch;
using bench::TorusRays;

/// A camera's rays: one eye, directions side by side.
struct FloatRays {
  std::array<float, 3> eye;
  std::array<std::vector<float>, 3> direction;
  std::vector<Ray> records;  ///< the same numbers

  explicit FloatRays(const std::vector<Ray>& rays) {
    const auto narrow = [](const Vec3& v) {
      return std::array{static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
    };
    eye = narrow(rays[0].origin);
    for (const Ray& ray : rays) {
      const std::array d = narrow(ray.direction);
      for (std::size_t c = 0; c < 3; ++c) direction[c].push_back(d[c]);
      Ray record;
      record.origin = {eye[0], eye[1], eye[2]}, record.direction = {d[0], d[1], d[2]};
      records.push_back(record);
    }
  }
  RayViews<float> views() const {
    RayViews<float> out;
    out.origin = {{&eye[0], &eye[1], &eye[2]}, 0, 1};
    out.direction = View3<const float>::soa({direction[0], direction[1], direction[2]});
    return out;
  }
};

/// Shared by the cases of one set and instruction set. Only one exists at a time.
struct Scene {
  explicit Scene(bool is_rational, Isa on)
      : work(60, is_rational),
        isa(on),
        rays(work.rays.at("coherent")),
        patches(test::value_of(RayScene::make(work.set, {.isa = on}))),
        instances(test::value_of(RayScene::make(std::vector<RayInstance>{
            {&patches, Affine{}}, {&patches, Affine::translated({0, 0, 0.3}) * Affine::scaled({0.5, 0.5, 0.5})}}))) {}

  TorusRays work;
  Isa isa;
  FloatRays rays;
  RayScene patches, instances;
};

const Scene& scene_of(bool is_rational, Isa isa) {
  static std::unique_ptr<Scene> scene;
  if (!scene || scene->work.is_rational != is_rational || scene->isa != isa) {
    scene.reset();
    scene = std::make_unique<Scene>(is_rational, isa);
  }
  return *scene;
}

struct Case {
  std::string operation;
  bool has_instances = false, shades = false, filters = false;
};

void closest_hits(benchmark::State& state, const Scene& scenes, const Case& what, int threads) {
  const RayScene& scene = what.has_instances ? scenes.instances : scenes.patches;
  std::vector<float> t(ray_count), u(ray_count), v(ray_count), position(3 * ray_count), normal(3 * ray_count);
  std::vector<std::uint32_t> patch(ray_count);
  HitViews<float> out;
  out.t = View1<float>::soa({t}), out.u = View1<float>::soa({u}), out.v = View1<float>::soa({v});
  out.patch = View1<std::uint32_t>::soa({patch});
  if (what.shades) {
    out.position = View3<float>::interleaved(position), out.normal = View3<float>::interleaved(normal);
  }
  BatchOptions options;
  if (what.filters) options.filter = [](const HitCandidate&) { return HitVerdict::accept; };
  std::vector<Hit> hits(ray_count);
  Stopwatch records;
  const auto best = bench::time_calls(
      state, threads, [&] { return closest(scene, scenes.rays.views(), out, options); },
      [&] { records.time(threads, [&] { (void)scene.closest(scenes.rays.records, hits); }); });
  if (!best) return;
  std::size_t met = 0, wrong = 0;
  for (std::size_t k = 0; k < ray_count; ++k) {
    const Hit& hit = hits[k];
    const bool is_hit = hit.kind == HitKind::hit;
    met += is_hit;
    wrong += t[k] != static_cast<float>(hit.t) || patch[k] != (is_hit ? hit.patch : out.no_hit) ||
             u[k] != static_cast<float>(hit.u) || v[k] != static_cast<float>(hit.v);
    if (what.shades)
      wrong += position[3 * k] != static_cast<float>(hit.position.x) ||
               normal[3 * k + 2] != static_cast<float>(hit.normal.z);
  }
  if (wrong > 0 || met < ray_count / 2)
    return state.SkipWithError((std::to_string(wrong) + " hits are not those of the records").c_str());
  bench::report_rates(state, *best, static_cast<double>(ray_count));
  state.counters["ns_per_ray"] = *best / static_cast<double>(ray_count) * 1e9;
  state.counters["of_records"] = *best / records.best();
}

void occlusion(benchmark::State& state, const Scene& scenes, const Case& what, int threads) {
  const RayScene& scene = what.has_instances ? scenes.instances : scenes.patches;
  std::vector<std::uint8_t> dark(ray_count), expected(ray_count);
  Stopwatch records;
  const auto best = bench::time_calls(
      state, threads, [&] { return occluded(scene, scenes.rays.views(), View1<std::uint8_t>::soa({dark})); },
      [&] { records.time(threads, [&] { (void)scene.occluded(scenes.rays.records, expected); }); });
  if (!best) return;
  if (dark != expected || std::count(dark.begin(), dark.end(), 1) < static_cast<std::ptrdiff_t>(ray_count / 2))
    return state.SkipWithError("rays are not occluded as the records are");
  bench::report_rates(state, *best, static_cast<double>(ray_count));
  state.counters["ns_per_ray"] = *best / static_cast<double>(ray_count) * 1e9;
  state.counters["of_records"] = *best / records.best();
}

[[maybe_unused]] const bool registered = [] {
  const std::vector<Case> cases = {{.operation = "t+uv+patch"},
                                   {.operation = "t+uv+patch+position+normal", .shades = true},
                                   {.operation = "t+uv+patch.filter", .filters = true},
                                   {.operation = "t+uv+patch.instances", .has_instances = true}};
  for (const bool is_rational : {false, true}) {
    for (const Isa isa : available_isas()) {
      if (isa == Isa::sse2) continue;
      for (const int threads : {1, 2}) {
        const auto part = threads == 1 && !is_rational ? bench::quick_on_fastest(isa) : bench::Part::full;
        const auto name_of = [&](const std::string& operation) {
          return bench::CaseName{"ray.exact.batch." + operation, is_rational ? "torus3600rational" : "torus3600",
                                 is_rational ? "3r" : "3",       std::to_string(ray_count),
                                 std::string(name(isa)),         threads};
        };
        for (const Case& one : cases)
          bench::add_case(name_of(one.operation), part, [=](benchmark::State& state) {
            closest_hits(state, scene_of(is_rational, isa), one, threads);
          });
        bench::add_case(name_of("occluded"), part,
                        [=](benchmark::State& state) { occlusion(state, scene_of(is_rational, isa), {}, threads); });
      }
    }
  }
  return true;
}();

}  // namespace
