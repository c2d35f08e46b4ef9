// Exact scenes that follow edits: a refitted scene answers like a new one, and queries from many threads run between
// edits.

#include <algorithm>
#include <atomic>
#include <numeric>
#include <thread>

#include "ray_support.h"
#include "support/torus.h"
#include "tessera/evaluate.h"

namespace tessera::test { namespace {

RayScene editable_scene(const PatchSet& set, int rebuild_after = 0) {
  return value_of(RayScene::make(set, {.editable = true, .rebuild_after = rebuild_after}));
}

std::vector<Vec3> points_of(const BezierPatch& patch) { return {patch.points().begin(), patch.points().end()}; }

bool contains(const Box3& box, const Box3& other, double by) {
  const Vec3 low = other.lower - box.lower, high = box.upper - other.upper;
  return std::min({low.x, low.y, low.z, high.x, high.y, high.z}) >= -by;
}

/// Expects the answers of a new scene; returns the number of hits.
std::size_t expect_as_made_anew(const RayScene& scene, const PatchSet& set, std::uint64_t seed) {
  const RayScene fresh = value_of(RayScene::make(set));
  EXPECT_EQ(scene.revision(), set.revision());
  const double tolerance = 1e-11 * set.box().diagonal();
  EXPECT_TRUE(contains(set.box(), scene.box(), tolerance));
  const std::vector<Ray> rays = rays_through(set.box(), 4000, seed);
  const std::vector<Hit> hits = closest(scene, rays), expected = closest(fresh, rays);
  HitLists lists, all_expected;
  EXPECT_TRUE(scene.all(rays, lists).ok() && fresh.all(rays, all_expected).ok());
  EXPECT_EQ(lists.first, all_expected.first);
  std::size_t met = 0;
  for (std::size_t k = 0; k < rays.size(); ++k) {
    EXPECT_EQ(hits[k].kind, expected[k].kind) << k;
    EXPECT_EQ(scene.occluded(rays[k]), hits[k].kind) << k;
    if (hits[k].kind != HitKind::hit) continue;
    ++met;
    EXPECT_TRUE(contains(scene.box(), {hits[k].position, hits[k].position}, tolerance));
    const double sine = std::abs(dot(expected[k].normal, normalized(rays[k].direction)));
    EXPECT_LT(std::abs(hits[k].t - expected[k].t) * length(rays[k].direction) * std::min(1.0, sine), tolerance) << k;
    EXPECT_LT(length(hits[k].position - expected[k].position) * std::min(1.0, sine), tolerance) << k;
  }
  return met;
}

TEST(Refit, AnswersAsASceneMadeAnew) {
  for (const bool is_rational : {false, true}) {
    const std::vector<BezierPatch> patches = Torus(8).patches(is_rational);
    PatchSet set = set_of(patches);
    RayScene scene = editable_scene(set);
    Random random(7);
    for (std::uint64_t round = 0; round < 6; ++round) {
      for (int edit = 0; edit < 5; ++edit) {
        const std::size_t k = random() % patches.size();
        std::vector<Vec3> points = points_of(set.patch(k));
        for (Vec3& p : points) p += uniform_vector(random, -0.1, 0.1);
        ASSERT_TRUE(set.set_control_points(k, points).ok());
      }
      ASSERT_TRUE(scene.refit().ok());
      EXPECT_GT(expect_as_made_anew(scene, set, 100 + round), 500u);
    }
  }
}

/// Moves each patch to where another one was, then all of them far away and to another size, and back.
TEST(Refit, EveryPatchMovedFar) {
  const std::vector<BezierPatch> patches = Torus(8).patches(false);
  PatchSet set = set_of(patches);
  RayScene scene = editable_scene(set);
  const auto move = [&](auto place) {
    for (std::size_t k = 0; k < patches.size(); ++k) {
      std::vector<Vec3> points = points_of(patches[place(k)]);
      ASSERT_TRUE(set.set_control_points(k, points).ok());
    }
    ASSERT_TRUE(scene.refit().ok());
    EXPECT_GT(expect_as_made_anew(scene, set, 200), 500u);
  };
  move([&](std::size_t k) { return (29 * k + 3) % patches.size(); });
  for (const double scale : {1e-3, 50.0}) {
    for (std::size_t k = 0; k < patches.size(); ++k) {
      std::vector<Vec3> points = points_of(patches[k]);
      for (Vec3& p : points) p = scale * p + Vec3{100, -50, 7};
      ASSERT_TRUE(set.set_control_points(k, points).ok());
    }
    ASSERT_TRUE(scene.refit().ok());
    EXPECT_GT(expect_as_made_anew(scene, set, 300), 500u);
  }
  move([](std::size_t k) { return k; });
}

/// Patches that are straight when they are cut and bend afterwards, for every interval of rebuilds.
TEST(Refit, StrongBendsAfterwards) {
  for (const int rebuild_after : {0, 1, 2}) {
    std::vector<Vec3> flat(16);
    for (std::size_t k = 0; k < 16; ++k) flat[k] = {static_cast<double>(k / 4), static_cast<double>(k % 4), 0};
    PatchSet set = set_of({polynomial(3, 3, flat), polynomial(3, 3, flat)});
    RayScene scene = editable_scene(set, rebuild_after);
    Random random(9);
    for (std::uint64_t round = 0; round < 4; ++round) {
      std::vector<Vec3> points(16);
      for (Vec3& p : points) p = uniform_vector(random, 0, 3);
      ASSERT_TRUE(set.set_control_points(1, points).ok());
      ASSERT_TRUE(scene.refit().ok());
      EXPECT_GT(expect_as_made_anew(scene, set, 400 + round), 500u);
    }
  }
}

TEST(Refit, SceneThatWasNotMadeForIt) {
  PatchSet set = set_of(Torus(6).patches(false));
  RayScene scene = value_of(RayScene::make(set));
  for (const double by : {0.1, 0.2}) {
    std::vector<Vec3> points = points_of(set.patch(3));
    for (Vec3& p : points) p.z += by;
    ASSERT_TRUE(set.set_control_points(3, points).ok());
    ASSERT_TRUE(scene.refit().ok());
    EXPECT_GT(expect_as_made_anew(scene, set, 17), 500u);
  }
}

TEST(Refit, EditsInOnePassAreSeen) {
  const std::vector<BezierPatch> patches = wavy_field(5, 4);
  PatchSet set = set_of(patches);
  RayScene scene = editable_scene(set);
  GridUpdate update = value_of(GridUpdate::make(set));
  const std::vector<double> ends = uniform_parameters(2);
  const GridPlan plan = value_of(GridPlan::make(set, ends, ends));
  std::vector<float> memory(3 * plan.capacity());
  const QuantityViews<float> out{.position = View3<float>::interleaved(memory), .du = {}, .dv = {}, .normal = {}};
  const std::vector<std::uint32_t> edited{11, 2};
  std::vector<Vec3> points;
  for (const std::uint32_t k : edited) {
    for (const Vec3& p : patches[k].points()) points.push_back(p + Vec3{0, 0, 1.5});
  }
  ASSERT_TRUE(update.run(set, plan, {edited, points}, out).ok());
  EXPECT_EQ(scene.closest(ray({0, 0, 9}, {0, 0, -1})).kind, HitKind::invalid_ray);
  ASSERT_TRUE(scene.refit().ok());
  EXPECT_GT(expect_as_made_anew(scene, set, 18), 500u);
}

TEST(Refit, TornAndWeldedBorders) {
  const std::vector<BezierPatch> patches = wavy_field(2, 1);
  PatchSet set = set_of(patches);
  RayScene scene = editable_scene(set);
  const Vec3 seam = de_casteljau(patches[0], 1, 0.5);
  const Ray down = ray(seam + Vec3{0, 0, 5}, {0, 0, -1});
  const auto met = [&] {
    HitLists lists;
    EXPECT_TRUE(scene.all({&down, 1}, lists).ok());
    return lists.hits.size();
  };
  EXPECT_EQ(met(), 1u);
  std::vector<Vec3> points = points_of(patches[1]);
  for (Vec3& p : points) p.z -= 1;
  ASSERT_TRUE(set.set_control_points(1, points).ok());
  ASSERT_TRUE(scene.refit().ok());
  EXPECT_EQ(met(), 2u);
  ASSERT_TRUE(set.set_control_points(1, patches[1].points()).ok());
  ASSERT_TRUE(scene.refit().ok());
  EXPECT_EQ(met(), 1u);
}

TEST(Refit, UncommittedEditsAreErrors) {
  PatchSet set = set_of(sphere());
  RayScene scene = editable_scene(set);
  const Ray down = ray({0.1, 0.1, 5}, {0, 0, -1});
  ASSERT_TRUE(set.set_control_points(0, points_of(set.patch(0))).ok());
  Hit hit;
  std::uint8_t occluded = 0;
  HitLists lists;
  const auto expect_stale = [&] {
    EXPECT_EQ(scene.closest({&down, 1}, {&hit, 1}).code(), StatusCode::stale);
    EXPECT_EQ(scene.occluded({&down, 1}, {&occluded, 1}).code(), StatusCode::stale);
    EXPECT_EQ(scene.all({&down, 1}, lists).code(), StatusCode::stale);
    EXPECT_EQ(scene.closest(down).kind, HitKind::invalid_ray);
    EXPECT_EQ(scene.occluded(down), HitKind::invalid_ray);
  };
  expect_stale();
  const std::atomic<bool> cancel = true;
  EXPECT_EQ(scene.refit({.cancel = &cancel}).code(), StatusCode::cancelled);
  expect_stale();
  ASSERT_TRUE(scene.refit().ok());
  EXPECT_EQ(scene.closest(down).kind, HitKind::hit);
  ASSERT_TRUE(scene.refit({.cancel = &cancel}).ok());  // nothing to do
  EXPECT_EQ(scene.closest(down).kind, HitKind::hit);
  EXPECT_EQ(scene.rebuild({.cancel = &cancel}).code(), StatusCode::cancelled);
  expect_stale();
  ASSERT_TRUE(scene.rebuild().ok());
  EXPECT_EQ(scene.closest(down).kind, HitKind::hit);
  EXPECT_EQ(RayScene::make(set, {.rebuild_after = -1}).status().code(), StatusCode::invalid_argument);
}

/// Every kind of const call from several threads at once, edits and refits in between.
TEST(Refit, ThreadsBetweenEdits) {
  PatchSet set = set_of(Torus(6).patches(false));
  RayScene scene = editable_scene(set);
  const std::vector<Ray> rays = rays_through(set.box(), 600, 23);
  for (int round = 0; round < 4; ++round) {
    std::vector<Vec3> points = points_of(set.patch(7));
    for (Vec3& p : points) p += Vec3{0.01, 0, 0.02};
    ASSERT_TRUE(set.set_control_points(7, points).ok());
    ASSERT_TRUE(scene.refit().ok());
    constexpr std::size_t threads = 4;
    std::vector<HitLists> lists(threads);
    std::vector<std::vector<Hit>> hits(threads, std::vector<Hit>(rays.size()));
    std::atomic<std::size_t> faults = 0, differ = 0;
    std::vector<std::thread> running;
    for (std::size_t k = 0; k < threads; ++k) {
      running.emplace_back([&, k] {
        faults += !scene.all(rays, lists[k]).ok() + !scene.closest(rays, hits[k]).ok() + (scene.memory_bytes() == 0);
        for (std::size_t j = k; j < rays.size(); j += 7)
          differ += (scene.occluded(rays[j]) == HitKind::hit) != (hits[k][j].kind == HitKind::hit);
      });
    }
    for (std::thread& one : running) one.join();
    EXPECT_EQ(faults, 0u);
    EXPECT_EQ(differ, 0u);
    for (std::size_t k = 1; k < threads; ++k) {
      EXPECT_EQ(lists[k].first, lists[0].first);
      for (std::size_t j = 0; j < rays.size(); ++j) ASSERT_EQ(hits[k][j].t, hits[0][j].t);
    }
  }
}

}}  // namespace tessera::test
