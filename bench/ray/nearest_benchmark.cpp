// Nearest points of a bicubic spline, for points near it and anywhere in its box, parameters of points on it, and which
// points lie inside of a body beside closest hits of as many rays. Each case checks that its results are proven.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "suite.h"
#include "support/random_patches.h"
#include "support/synthetic_sets.h"
#include "support/torus.h"
#include "tessera/model.h"
#include "tessera/solid.h"
#include "timing.h"

namespace tessera::bench { namespace {

constexpr std::size_t point_count = 20000, many_points = 200000;

/// A spline of side x side bicubic patches of size 1 with waves of height 0.5, without creases.
PatchSet waves(int side) {
  std::vector<double> knots;
  for (int k = -3; k <= side + 3; ++k) knots.push_back(std::clamp(k, 0, side));
  std::vector<Vec3> points;
  for (int i = -1; i <= side + 1; ++i)
    for (int j = -1; j <= side + 1; ++j)
      points.push_back(
          {double(i), double(j), 0.35 * std::sin(0.9 * i) * std::cos(0.7 * j) + 0.15 * std::sin(1.9 * i + j)});
  const auto spline = test::value_of(BSplineSurface::polynomial(3, knots, 3, knots, points));
  Model model;
  model.surfaces.push_back({.name = std::string("waves"), .surface = spline});
  return test::value_of(make_patch_set(model));
}

/// Points within 1% of a patch's length of the surface, or anywhere in its box.
std::vector<Vec3> points_at(const PatchSet& set, std::size_t count, bool near) {
  test::Random random(1);
  const Box3 box = set.box();
  std::vector<Vec3> points;
  for (std::size_t k = 0; k < count; ++k) {
    if (near) {
      const auto patch = static_cast<std::uint32_t>(random() % set.patch_count());
      const SurfaceJet jet = evaluate_jet(set.patch(patch), test::uniform(random, 0, 1), test::uniform(random, 0, 1));
      points.push_back(jet.position + test::uniform(random, -0.01, 0.01) * normalized(cross(jet.du, jet.dv)));
    } else {
      points.push_back({test::uniform(random, box.lower.x, box.upper.x),
                        test::uniform(random, box.lower.y, box.upper.y),
                        test::uniform(random, box.lower.z, box.upper.z)});
    }
  }
  return points;
}

void nearest_points(benchmark::State& state, int side, std::size_t count, bool near) {
  const PatchSet set = waves(side);
  const PointScene scene = test::value_of(PointScene::make(set));
  const std::vector<Vec3> points = points_at(set, count, near);
  std::vector<NearestPoint> found(points.size());
  const auto best = time_calls(state, 1, [&] { return scene.nearest(points, found); });
  if (!best) return;
  for (std::size_t k = 0; k < points.size(); ++k)
    if (!found[k].flags.certified || std::abs(length(found[k].position - points[k]) - found[k].distance) > 1e-12)
      return state.SkipWithError("a nearest point is not proven, or its distance is wrong");
  state.counters["ns_a_point"] = 1e9 * *best / double(points.size());
  state.counters["bytes_a_patch"] = double(scene.memory_bytes()) / double(set.patch_count());
}

/// Points on the surface, to their parameters.
void places_of_points(benchmark::State& state, int side, std::size_t count) {
  const PatchSet set = waves(side);
  const PointScene scene = test::value_of(PointScene::make(set));
  std::vector<Vec3> points = points_at(set, count, true);
  std::vector<NearestPoint> nearest(points.size());
  if (!scene.nearest(points, nearest).ok()) return state.SkipWithError("no nearest points");
  for (std::size_t k = 0; k < points.size(); ++k) points[k] = nearest[k].position;
  constexpr double distance = 1e-9;
  SurfacePlaces found;
  const auto best = time_calls(state, 1, [&] { return scene.places(points, distance, found); });
  if (!best) return;
  for (std::size_t k = 0; k < points.size(); ++k)
    if (found.first[k] == found.first[k + 1] || length(found.places[found.first[k]].position - points[k]) > distance)
      return state.SkipWithError("a point of the surface is not found there");
  state.counters["ns_a_point"] = 1e9 * *best / double(points.size());
}

void contained_points(benchmark::State& state) {
  const PatchSet set = test::value_of(PatchSet::make(test::Torus(12).patches(false)));
  const RayScene scene = test::value_of(RayScene::make(set));
  const Solid solid = test::value_of(Solid::make(scene));
  const std::vector<Vec3> points = points_at(set, point_count, false);
  std::vector<Containment> sides(points.size());
  std::vector<Hit> hits(points.size());
  std::vector<Ray> rays;
  for (const Vec3& point : points) rays.push_back({.origin = point, .direction = {0.36172, 0.51394, 0.77787}});
  double closest = std::numeric_limits<double>::infinity();
  const auto best = time_calls(
      state, 1, [&] { return solid.contains(points, sides); },
      [&] {
        const auto start = std::chrono::steady_clock::now();
        (void)scene.closest(rays, hits);
        closest = std::min(closest, seconds_since(start));
      });
  if (!best) return;
  for (const Containment& side : sides)
    if (!side.certified) return state.SkipWithError("a side is not certified");
  state.counters["ns_a_point"] = 1e9 * *best / double(points.size());
  state.counters["closest_hits"] = *best / closest;
}

const bool registered = [] {
  for (const int side : {60, 316}) {
    const std::size_t count = side == 60 ? point_count : many_points;
    for (const bool near : {true, false})
      add_case(
          {near ? "nearest.near" : "nearest.box", "waves" + std::to_string(side * side), "3", std::to_string(count)},
          side == 60 ? Part::quick : Part::full,
          [=](benchmark::State& state) { nearest_points(state, side, count, near); });
    add_case({"nearest.places", "waves" + std::to_string(side * side), "3", std::to_string(count)},
             side == 60 ? Part::quick : Part::full,
             [=](benchmark::State& state) { places_of_points(state, side, count); });
  }
  add_case({"solid.contains", "torus", "3", std::to_string(point_count)}, Part::quick, contained_points);
  return true;
}();

}}  // namespace tessera::bench
