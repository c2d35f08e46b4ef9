// Nearest points, and points inside of closed surfaces.

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "robustness/bad_input.h"
#include "support/grids.h"
#include "tessera/solid.h"

namespace tessera::test {
namespace {

using enum StatusCode;

constexpr std::size_t point_count = 5;
constexpr double infinite = std::numeric_limits<double>::infinity();

/// Points above a field, and room for what is nearest to them.
struct Near {
  std::vector<float> at;
  std::vector<float> distance = std::vector<float>(point_count, -77);
  std::vector<std::uint32_t> patch = std::vector<std::uint32_t>(point_count, 77);

  Near() {
    for (std::size_t k = 0; k < point_count; ++k) at.insert(at.end(), {0.5f, 0.5f, 1 + static_cast<float>(k)});
  }
  PointViews<float> points() const { return {.position = View3<const float>::interleaved(at)}; }
  NearestViews<float> nearest() {
    return {.patch = View1<std::uint32_t>::soa({patch}), .distance = View1<float>::soa({distance})};
  }
  bool untouched() const {
    return std::ranges::all_of(distance, [](float x) { return x == -77; }) &&
           std::ranges::all_of(patch, [](std::uint32_t x) { return x == 77; });
  }
};

void point_scenes(Table& table) {
  table.of("PointScene::make(set)");
  const auto square_of = [](double size) {
    return set_of({polynomial(1, 1, {{0, 0, 0}, {0, size, 0}, {size, 0, 0}, {size, size, 0}})});
  };
  table.row("a patch that is a point", unsupported, PointScene::make(square_of(0)));
  table.row("a square of side 1e-150", unsupported, PointScene::make(square_of(1e-150)));
}

void near_points(Table& table) {
  PatchSet set = set_of(wavy_field(2, 2));
  const PointScene scene = value_of(PointScene::make(set));
  table.of("PointScene::nearest(points, nearest, max_distance)");
  const std::vector<Vec3> two(2);
  std::vector<NearestPoint> one(1), room(2);
  table.row("2 points, room for 1", buffer_too_small, scene.nearest(two, one));
  table.row("max_distance -1", invalid_argument, scene.nearest(two, room, -1));
  table.row("max_distance NaN", invalid_argument, scene.nearest(two, room, not_a_number));
  for (const Vec3& wrong : {Vec3{not_a_number, 0, 0}, Vec3{0, infinite, 0}})
    table.gives("a point that is not finite", "an invalid point",
                scene.nearest(wrong).kind == NearestKind::invalid_point);
  table.gives("a point 1e300 away", "an invalid point",
              scene.nearest({1e300, 0, 0}).kind == NearestKind::invalid_point);
  const NearestPoint far = scene.nearest({1e100, 0, 0});
  table.gives("a point 1e100 away", "a point of the surface",
              far.kind == NearestKind::found && std::isfinite(far.distance + far.position.x));
  table.of("nearest(scene, points, nearest)");
  Near near;
  const auto untouched = [&] { return near.untouched(); };
  NearestViews<float> out = near.nearest();
  out.distance.size = 3;
  table.row("room for 3 distances", buffer_too_small, nearest(scene, near.points(), out), untouched);
  out = near.nearest();
  out.distance.stride = 0;
  table.row("distances of stride 0", invalid_argument, nearest(scene, near.points(), out), untouched);
  table.row("no output", invalid_argument, nearest(scene, near.points(), NearestViews<float>{}), untouched);
  PointViews<float> in = near.points();
  in.position.component[1] = nullptr;
  table.row("positions without y", invalid_argument, nearest(scene, in, near.nearest()), untouched);
  in = near.points();
  in.max_distance = View1<const float>::soa({std::span(near.at).first(2)});
  table.row("2 largest distances", count_mismatch, nearest(scene, in, near.nearest()), untouched);
  (void)set.set_control_points(0, set.patch(1).points());
  table.row("the set was edited", stale, nearest(scene, near.points(), near.nearest()), untouched);
}

void contained_points(Table& table) {
  PatchSet set = set_of(wavy_field(2, 2));
  RayScene rays = value_of(RayScene::make(set));
  table.of("Solid::make(scene)");
  table.row("a scene in grid mode", unsupported, Solid::make(value_of(RayScene::make(set, {.mode = RayMode::grid}))));
  table.row("a scene of 1 of 4 patches", unsupported, Solid::make(value_of(RayScene::make(set, {.patches = 1}))));
  const Solid solid = value_of(Solid::make(rays));
  table.gives("a field", "an open surface", !solid.is_closed());
  table.of("Solid::contains(points, sides)");
  const std::vector<Vec3> two(2);
  std::vector<Containment> one(1);
  table.row("2 points, room for 1", buffer_too_small, solid.contains(two, one));
  table.gives("a point that is not finite", "an invalid point",
              solid.contains({0, not_a_number, 0}).side == PointSide::invalid_point);
  table.gives("a point, but an open surface", "a side that is not certified", !solid.contains({1, 1, 0}).certified);
  table.of("Solid::winding_numbers(points, numbers)");
  std::vector<double> number(1);
  const auto number_of = [&](const Vec3& point) {
    return solid.winding_numbers({&point, 1}, number).ok() ? number[0] : infinite;
  };
  table.row("2 points, room for 1", buffer_too_small, solid.winding_numbers(two, number));
  table.gives("a point that is not finite", "NaN", std::isnan(number_of({0, not_a_number, 0})));
  table.gives("a point 1e300 away", "NaN", std::isnan(number_of({0, 1e300, 0})));
  table.gives("a point 1e18 away", "a number near 0", std::abs(number_of({0, 1e18, 0})) < 1e-12);
  table.gives("a corner of the field", "a number", std::isfinite(number_of(set.patch(0).point(0, 0))));
  table.of("signed_distances(solid, scene, points, distances)");
  const PointScene scene = value_of(PointScene::make(set));
  std::vector<double> distance(1);
  table.row("2 points, room for 1", buffer_too_small, signed_distances(solid, scene, two, distance));
  (void)set.set_control_points(0, set.patch(1).points());
  one.resize(2);
  table.row("the set was edited", stale, solid.contains(two, one));
  table.row("the set was edited", stale, Solid::make(rays));
}

}  // namespace

void fill_queries(Table& table) {
  point_scenes(table);
  near_points(table);
  contained_points(table);
}

}  // namespace tessera::test
