// Rays and their scenes.

#include <array>

#include "robustness/bad_input.h"
#include "support/grids.h"
#include "tessera/ray_scene.h"

namespace tessera::test {
namespace {

using enum StatusCode;

constexpr Ray sound_ray{.origin = {0.5, 0.5, 5}, .direction = {0, 0, -1}};

void scenes(Table& table) {
  const PatchSet set = set_of(wavy_field(1, 1));
  const auto row = [&](const std::string& input, StatusCode code, const RaySceneOptions& options) {
    table.row(input, code, RayScene::make(set, options));
  };
  table.of("RayScene::make(set, options, execution)");
  row("an unknown mode", invalid_argument, {.mode = RayMode{7}});
  row("grid mode, rate 0", invalid_argument, {.mode = RayMode::grid, .rate = 0});
  row("grid mode, rate 4097", invalid_argument, {.mode = RayMode::grid, .rate = 4097});
  for (const int pieces : {0, 3, 16, -1}) row(std::to_string(pieces) + " pieces", invalid_argument, {.pieces = pieces});
  for (const auto& [tolerance, name] :
       {std::pair{0.0, "0"}, {-1.0, "-1"}, {not_a_number, "NaN"}, {infinity, "infinity"}})
    row(std::string("a tolerance of ") + name, invalid_argument, {.tolerance = tolerance});
  row("an unknown instruction set", isa_unavailable, {.isa = Isa{9}});
  const std::vector<Vec3> point(16, Vec3{1, 2, 3});
  const PatchSet degenerate = set_of({*BezierPatch::polynomial(3, 3, point), *BezierPatch::polynomial(3, 3, point)});
  table.row("a set whose every patch is one point", unsupported, RayScene::make(degenerate));
  table.row("a set whose every patch is one point, grid mode", unsupported,
            RayScene::make(degenerate, {.mode = RayMode::grid}));
  std::vector<Vec3> line;
  for (int k = 0; k < 16; ++k) line.push_back({static_cast<double>(k / 4), 0, 0});
  const PatchSet curve = set_of({*BezierPatch::polynomial(3, 3, line)});
  for (const RayMode mode : {RayMode::exact, RayMode::grid}) {
    const auto scene = RayScene::make(curve, {.mode = mode});
    const Hit hit = scene ? scene->closest({.origin = {0.5, 1, 5}, .direction = {0, 0, -1}}) : Hit{};
    table.gives(std::string("a set whose every patch is a line") + (mode == RayMode::grid ? ", grid mode" : ""),
                "a scene; a ray beside the line misses", scene.ok() && hit.kind == HitKind::miss);
  }
  const std::atomic<bool> cancel = true;
  table.row("a cancellation", cancelled, RayScene::make(set, {}, {.cancel = &cancel}));
}

/// Rays that are not valid, each a miss of its own kind.
void bad_single_rays(Table& table, const RayScene& scene) {
  const auto row = [&](const std::string& input, auto spoil) {
    Ray ray = sound_ray;
    spoil(ray);
    std::array<Hit, 3> hits;
    const std::array rays{sound_ray, ray, sound_ray};
    std::array<std::uint8_t, 3> dark{7, 7, 7};
    const bool answered = scene.closest(rays, hits).ok() && scene.occluded(rays, dark).ok();
    const Hit &first = hits[0], &hit = hits[1];
    table.gives(input, "HitKind::invalid_ray, not occluded; the rays beside it are answered",
                answered && hit.kind == HitKind::invalid_ray && hit.t == infinity && dark[1] == 0 &&
                    first.kind == HitKind::hit && hits[2].t == first.t && dark[0] == 1 && dark[2] == 1 &&
                    scene.closest(ray).kind == HitKind::invalid_ray && scene.occluded(ray) == HitKind::invalid_ray);
  };
  row("NaN in the origin", [](Ray& r) { r.origin.y = not_a_number; });
  row("infinity in the origin", [](Ray& r) { r.origin.z = infinity; });
  row("an origin of 2e18", [](Ray& r) { r.origin.x = 2e18; });
  row("an origin of 1e300", [](Ray& r) { r.origin.x = -1e300; });
  row("a direction of 0", [](Ray& r) { r.direction = {}; });
  row("a direction of -0", [](Ray& r) { r.direction = {-0.0, 0.0, -0.0}; });
  row("NaN in the direction", [](Ray& r) { r.direction.x = not_a_number; });
  row("infinity in the direction", [](Ray& r) { r.direction.z = -infinity; });
  row("a direction of 1e300", [](Ray& r) { r.direction.z = -1e300; });
  row("tnear of NaN", [](Ray& r) { r.tnear = not_a_number; });
  row("a negative tnear", [](Ray& r) { r.tnear = -1e-300; });
  row("tfar of NaN", [](Ray& r) { r.tfar = not_a_number; });
  row("tfar below tnear", [](Ray& r) {
    r.tnear = 2;
    r.tfar = 1;
  });
}

void unusual_rays(Table& table, const RayScene& scene) {
  const auto kind = [&](auto change) {
    Ray ray = sound_ray;
    change(ray);
    return scene.closest(ray).kind;
  };
  table.gives("a direction of 1e18", "a hit", kind([](Ray& r) { r.direction.z = -1e18; }) == HitKind::hit);
  table.gives("a direction of 1e-300", "a hit", kind([](Ray& r) { r.direction.z = -1e-300; }) == HitKind::hit);
  table.gives("a subnormal direction, so that t does not exist in double", "a miss",
              kind([](Ray& r) { r.direction.z = -5e-324; }) == HitKind::miss);
  table.gives("an infinite tnear", "a miss", kind([](Ray& r) { r.tnear = infinity; }) == HitKind::miss);
  table.gives("an origin of 1e18, looking away", "a miss", kind([](Ray& r) {
                                                             r.origin = {0, 0, 1e18};
                                                             r.direction = {1, 0, 0};
                                                           }) == HitKind::miss);
}

void rays_as_batches(Table& table, const std::string& mode, const RaySceneOptions& options) {
  PatchSet set = set_of(wavy_field(1, 1));
  const RayScene scene = value_of(RayScene::make(set, options));
  table.of("RayScene::closest, occluded(rays, results), " + mode);
  bad_single_rays(table, scene);
  unusual_rays(table, scene);
  const std::vector<Ray> rays(5, sound_ray);
  std::vector<Hit> hits(5);
  std::vector<std::uint8_t> dark(5, 7);
  const auto untouched = [&] {
    return std::ranges::all_of(hits, [](const Hit& h) { return h.kind == HitKind::miss && h.t == infinity; }) &&
           std::ranges::all_of(dark, [](std::uint8_t d) { return d == 7; });
  };
  table.gives("no rays", "nothing written", scene.closest({}, hits).ok() && untouched());
  table.row("hits short by one", buffer_too_small, scene.closest(rays, std::span(hits).first(4)), untouched);
  table.row("occlusions short by one", buffer_too_small, scene.occluded(rays, std::span(dark).first(4)), untouched);
  const std::atomic<bool> cancel = true;
  table.row("a cancellation before the first task", cancelled, scene.closest(rays, hits, {.cancel = &cancel}),
            untouched);
  HitLists lists{.hits = std::vector<Hit>(3), .first = {0, 3}};
  const auto empty = [&] { return lists.hits.empty() && lists.first.size() <= 1; };
  if (options.mode == RayMode::grid) {
    table.row("all(): grid mode", unsupported, scene.all(rays, lists), empty);
  } else {
    table.row("all(): a cancellation", cancelled, scene.all(rays, lists, {.cancel = &cancel}), empty);
  }
  const std::vector<Vec3> points(set.patch(0).points().begin(), set.patch(0).points().end());
  (void)set.set_control_points(0, points);
  table.row("a set that was edited since", stale, scene.closest(rays, hits), untouched);
  table.row("a set that was edited since: occluded()", stale, scene.occluded(rays, dark), untouched);
  table.row("a set that was edited since: all()", stale, scene.all(rays, lists), empty);
  table.gives(
      "a set that was edited since, one ray", "HitKind::invalid_ray, of closest() and occluded()",
      scene.closest(sound_ray).kind == HitKind::invalid_ray && scene.occluded(sound_ray) == HitKind::invalid_ray);
}

}  // namespace

void fill_rays(Table& table) {
  scenes(table);
  rays_as_batches(table, "exact mode", {});
  rays_as_batches(table, "grid mode", {.mode = RayMode::grid});
}

}  // namespace tessera::test
