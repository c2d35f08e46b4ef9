// Batches of rays in arrays.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <new>
#include <stdexcept>
#include <vector>

#include "robustness/bad_input.h"
#include "robustness/bad_views.h"
#include "support/grids.h"
#include "tessera/ray_scene.h"

namespace tessera::test {
namespace {

using enum StatusCode;

constexpr std::size_t count = 20;
constexpr float unwritten = -77;

/// Rays that meet the set, and room for their hits.
struct Batch {
  std::vector<float> origin, direction, tnear, tfar, spawn_offset;
  std::vector<std::uint32_t> mask;
  std::vector<float> t = std::vector<float>(count, unwritten), normal = std::vector<float>(3 * count, unwritten);
  std::vector<std::uint32_t> patch = std::vector<std::uint32_t>(count, 77);
  std::vector<HitKind> kind = std::vector<HitKind>(count, HitKind{9});
  std::vector<std::uint8_t> dark = std::vector<std::uint8_t>(count, 7);

  Batch() {
    for (std::size_t k = 0; k < count; ++k) {
      origin.insert(origin.end(), {0.5f + 0.001f * static_cast<float>(k), 0.5f, 5});
      direction.insert(direction.end(), {0, 0, -1});
      tnear.push_back(0), tfar.push_back(100), spawn_offset.push_back(0), mask.push_back(1);
    }
  }
  RayViews<float> rays() const {
    RayViews<float> out;
    out.origin = View3<const float>::interleaved(origin), out.direction = View3<const float>::interleaved(direction);
    out.tnear = View1<const float>::soa({tnear}), out.tfar = View1<const float>::soa({tfar});
    out.spawn_offset = View1<const float>::soa({spawn_offset}), out.mask = View1<const std::uint32_t>::soa({mask});
    return out;
  }
  HitViews<float> hits() {
    HitViews<float> out;
    out.t = View1<float>::soa({t}), out.normal = View3<float>::interleaved(normal);
    out.patch = View1<std::uint32_t>::soa({patch}), out.kind = View1<HitKind>::soa({kind});
    return out;
  }
  View1<std::uint8_t> occlusions() { return View1<std::uint8_t>::soa({dark}); }
  bool untouched() const {
    const auto all = [](const auto& of, auto value) {
      return std::ranges::all_of(of, [&](auto x) { return x == value; });
    };
    return all(t, unwritten) && all(normal, unwritten) && all(patch, 77u) && all(kind, HitKind{9}) && all(dark, 7);
  }
};

/// Calls of one scene, each with a batch of its own.
class Calls {
 public:
  Calls(Table& table, const RayScene& scene) : table_(table), scene_(scene) {}

  template <class Change>
  void rays(const std::string& input, StatusCode code, const Change& change) {
    Batch batch;
    RayViews<float> rays = batch.rays();
    change(rays);
    const auto untouched = [&] { return batch.untouched(); };
    const Status status = closest(scene_, rays, batch.hits());
    table_.row(input, code, status, untouched);
    EXPECT_EQ(occluded(scene_, rays, batch.occlusions()).message(), status.message()) << input;
    EXPECT_TRUE(untouched()) << input;
  }
  template <class Change>
  void hits(const std::string& input, StatusCode code, const Change& change) {
    Batch batch;
    HitViews<float> hits = batch.hits();
    change(hits, batch);
    table_.row(input, code, closest(scene_, batch.rays(), hits), [&] { return batch.untouched(); });
  }
  /// Spoils ray 7; the others are answered.
  template <class Spoil>
  void lane(const std::string& input, const Spoil& spoil) {
    Batch batch;
    spoil(batch);
    const bool answered =
        closest(scene_, batch.rays(), batch.hits()).ok() && occluded(scene_, batch.rays(), batch.occlusions()).ok();
    bool holds = answered;
    for (std::size_t k = 0; k < count; ++k) {
      const bool met = batch.kind[k] == HitKind::hit && batch.patch[k] == 0 && batch.dark[k] == 1 && batch.t[k] > 0;
      const bool refused = batch.kind[k] == HitKind::invalid_ray && batch.patch[k] == HitViews<float>::no_hit &&
                           batch.dark[k] == 0 && batch.t[k] == std::numeric_limits<float>::infinity();
      holds = holds && (k == 7 ? refused : met);
    }
    table_.gives(input, "HitKind::invalid_ray, not occluded; the rays beside it are answered", holds);
  }
  template <class Filter>
  void filter(const std::string& input, StatusCode code, const Filter& with) {
    Batch batch;
    const BatchOptions options{.filter = with};
    const Status status = closest(scene_, batch.rays(), batch.hits(), options);
    table_.row(input, code, status);
    EXPECT_EQ(occluded(scene_, batch.rays(), batch.occlusions(), options).message(), status.message()) << input;
  }

 private:
  Table& table_;
  const RayScene& scene_;
};

template <class View>
void bad_rays(Calls& calls, const std::string& name, View RayViews<float>::*view) {
  const auto with = [&](const std::string& what, StatusCode code, const auto& change) {
    calls.rays(name + " " + what, code, [&](RayViews<float>& rays) { change(rays.*view); });
  };
  with("with stride -1", invalid_argument, [](View& of) { of.stride = -1; });
  with("with the largest stride", invalid_argument,
       [](View& of) { of.stride = std::numeric_limits<std::ptrdiff_t>::max(); });
  with("misaligned", invalid_argument, [](View& of) { misalign(of); });
  if (name == "direction") return;  // its length is the number of rays
  with("short by one record", count_mismatch, [](View& of) { of.size = count - 1; });
  with("with stride 0 and no record", count_mismatch, [](View& of) { of.stride = 0, of.size = 0; });
}

void bad_lanes(Calls& calls) {
  constexpr auto nan = std::numeric_limits<float>::quiet_NaN(), infinite = std::numeric_limits<float>::infinity();
  calls.lane("NaN in an origin", [&](Batch& b) { b.origin[3 * 7 + 1] = nan; });
  calls.lane("infinity in an origin", [&](Batch& b) { b.origin[3 * 7] = -infinite; });
  calls.lane("an origin of 2e18", [&](Batch& b) { b.origin[3 * 7] = 2e18f; });
  calls.lane("NaN in a direction", [&](Batch& b) { b.direction[3 * 7 + 2] = nan; });
  calls.lane("infinity in a direction", [&](Batch& b) { b.direction[3 * 7 + 2] = infinite; });
  calls.lane("a direction of 0", [&](Batch& b) { b.direction[3 * 7 + 2] = -0.0f; });
  calls.lane("tnear of NaN", [&](Batch& b) { b.tnear[7] = nan; });
  calls.lane("a negative tnear", [&](Batch& b) { b.tnear[7] = -1e-40f; });
  calls.lane("tfar of NaN", [&](Batch& b) { b.tfar[7] = nan; });
  calls.lane("tfar below tnear", [&](Batch& b) { b.tnear[7] = 2, b.tfar[7] = 1; });
  calls.lane("spawn_offset of NaN", [&](Batch& b) { b.spawn_offset[7] = nan; });
  calls.lane("a negative spawn_offset", [&](Batch& b) { b.spawn_offset[7] = -1; });
}

void bad_outputs(Calls& calls) {
  Batch sound;
  bad_view(
      "normal", sound.hits(), count, [](HitViews<float> & hits) -> auto& { return hits.normal; },
      [&](const std::string& input, StatusCode code, const HitViews<float>& bad) {
        calls.hits(input, code, [&](HitViews<float>& hits, Batch& batch) {
          hits.normal = bad.normal;
          for (float*& component : hits.normal.component)  // of that batch's memory
            if (component != nullptr) component += batch.normal.data() - sound.normal.data();
        });
      });
  calls.hits("t short by one record", buffer_too_small, [](HitViews<float>& hits, Batch&) { hits.t.size = count - 1; });
  calls.hits("t with stride 0", invalid_argument, [](HitViews<float>& hits, Batch&) { hits.t.stride = 0; });
  calls.hits("t misaligned", invalid_argument, [](HitViews<float>& hits, Batch&) { misalign(hits.t); });
  calls.hits("t and normal in the same memory", invalid_argument,
             [](HitViews<float>& hits, Batch& batch) { hits.t = View1<float>::interleaved(batch.normal, 3); });
  calls.hits("t in the place of tfar", invalid_argument,
             [](HitViews<float>& hits, Batch& batch) { hits.t = View1<float>::soa({batch.tfar}); });
  calls.hits("no output", invalid_argument, [](HitViews<float>& hits, Batch&) { hits = {}; });
}

void filters(Table& table, Calls& calls) {
  const auto at_first_ray = [](HitVerdict verdict) {  // rays come in any order
    return [verdict](const HitCandidate& at) { return at.ray == 0 ? verdict : HitVerdict::accept; };
  };
  calls.filter("a filter that stops", cancelled, at_first_ray(HitVerdict::stop));
  calls.filter("a filter whose verdict is none", cancelled, at_first_ray(HitVerdict{7}));
  calls.filter("a filter that throws std::runtime_error(\"no texture\")", internal,
               [](const HitCandidate&) -> HitVerdict { throw std::runtime_error("no texture"); });
  calls.filter("a filter that throws std::bad_alloc", out_of_memory,
               [](const HitCandidate&) -> HitVerdict { throw std::bad_alloc(); });
  calls.filter("a filter that throws 7", internal, [](const HitCandidate&) -> HitVerdict { throw 7; });
  const PatchSet set = set_of(wavy_field(1, 1));
  const RayScene grid = value_of(RayScene::make(set, {.mode = RayMode::grid}));
  Batch batch;
  const BatchOptions accept{.filter = [](const HitCandidate&) { return HitVerdict::accept; }};
  table.row("a filter in grid mode", unsupported, closest(grid, batch.rays(), batch.hits(), accept),
            [&] { return batch.untouched(); });
}

}  // namespace

void fill_batches(Table& table) {
  PatchSet set = set_of(wavy_field(1, 1));
  const RayScene scene = value_of(RayScene::make(set));
  table.of("closest, occluded(scene, rays, results, options, execution), rays in arrays");
  Calls calls(table, scene);
  bad_rays(calls, "origin", &RayViews<float>::origin);
  bad_rays(calls, "direction", &RayViews<float>::direction);
  bad_rays(calls, "tnear", &RayViews<float>::tnear);
  bad_rays(calls, "tfar", &RayViews<float>::tfar);
  bad_rays(calls, "spawn_offset", &RayViews<float>::spawn_offset);
  bad_rays(calls, "mask", &RayViews<float>::mask);
  calls.rays("no origin", count_mismatch, [](RayViews<float>& rays) { rays.origin = {}; });
  calls.rays("an origin that lacks a component", invalid_argument,
             [](RayViews<float>& rays) { rays.origin.component[2] = nullptr; });
  calls.rays("a direction that lacks a component", invalid_argument,
             [](RayViews<float>& rays) { rays.direction.component[0] = nullptr; });
  bad_lanes(calls);
  bad_outputs(calls);
  filters(table, calls);
  Batch batch;
  const auto untouched = [&] { return batch.untouched(); };
  table.gives("no rays", "nothing written", closest(scene, RayViews<float>{}, batch.hits()).ok() && untouched());
  const std::atomic<bool> cancel = true;
  table.row("a cancellation before the first task", cancelled,
            closest(scene, batch.rays(), batch.hits(), {}, {.cancel = &cancel}), untouched);
  const std::vector<Vec3> points(set.patch(0).points().begin(), set.patch(0).points().end());
  (void)set.set_control_points(0, points);
  table.row("a set that was edited since", stale, closest(scene, batch.rays(), batch.hits()), untouched);
  table.row("a set that was edited since: occluded()", stale, occluded(scene, batch.rays(), batch.occlusions()),
            untouched);
}

}  // namespace tessera::test
