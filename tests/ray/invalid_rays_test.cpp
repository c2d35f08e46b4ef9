// Embree aborts on bad rays; none may reach it. Options and buffers that don't fit are errors.

#include <limits>

#include "ray_support.h"
#include "support/torus.h"

namespace tessera::test { namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

std::vector<Ray> bad_rays() {
  std::vector<Ray> rays;
  const auto add = [&](auto&& spoil) {
    Ray bad = ray({0, 0, 3}, {0, 0, -1});
    spoil(bad);
    rays.push_back(bad);
  };
  for (const double value : {nan, infinity, -infinity, 2e18, -2e18, 1e300}) {
    for (double Vec3::*axis : {&Vec3::x, &Vec3::y, &Vec3::z}) {
      add([&](Ray& r) { r.origin.*axis = value; });
      add([&](Ray& r) { r.direction.*axis = value; });
    }
  }
  add([](Ray& r) { r.direction = {}; });
  add([](Ray& r) { r.direction = {-0.0, 0.0, -0.0}; });
  add([](Ray& r) { r.tnear = nan; });
  add([](Ray& r) { r.tnear = -1e-300; });
  add([](Ray& r) { r.tnear = -infinity; });
  add([](Ray& r) { r.tfar = nan; });
  add([](Ray& r) { r.tfar = -infinity; });
  add([](Ray& r) { r.tnear = 2, r.tfar = 1; });
  return rays;
}

TEST(InvalidRays, AreMissesOfTheirOwnKind) {
  const PatchSet set = set_of(sphere());
  const RayScene scene = scene_of(set);
  for (const Ray& bad : bad_rays()) {
    const Hit hit = scene.closest(bad);
    EXPECT_EQ(hit.kind, HitKind::invalid_ray);
    EXPECT_EQ(hit.t, infinity);
    EXPECT_EQ(scene.occluded(bad), HitKind::invalid_ray);
  }
}

TEST(InvalidRays, DoNotDisturbTheirNeighbours) {
  const PatchSet set = set_of(sphere());
  const RayScene scene = scene_of(set);
  const Ray good = ray({0.1, 0.2, 3}, {0, 0, -1});
  const Hit expected = scene.closest(good);
  ASSERT_EQ(expected.kind, HitKind::hit);
  std::vector<Ray> rays;
  for (const Ray& bad : bad_rays()) {
    rays.push_back(good);
    rays.push_back(bad);
  }
  const std::vector<Hit> hits = closest(scene, rays);
  std::vector<std::uint8_t> occluded(rays.size(), 7);
  ASSERT_TRUE(scene.occluded(rays, occluded).ok());
  for (std::size_t k = 0; k < rays.size(); ++k) {
    EXPECT_EQ(hits[k].kind, k % 2 == 0 ? HitKind::hit : HitKind::invalid_ray) << k;
    if (k % 2 == 0) {
      EXPECT_NEAR(hits[k].t, expected.t, 1e-12);
    }
    EXPECT_EQ(occluded[k], k % 2 == 0 ? 1 : 0) << k;
  }
}

TEST(InvalidRays, UnusualButValid) {
  const PatchSet set = set_of(sphere());
  const RayScene scene = scene_of(set);
  // Directions of any length are directions.
  for (const double size : {5e-324, 1e-310, 1e-300, 1e-30, 1e30 / 1e13, 1.8e18}) {
    const Hit hit = scene.closest(ray({0.1, 0.2, 3}, {0, 0, -size}));
    const double arc = 3 - std::sqrt(1 - 0.05);
    if (arc / size < infinity) {
      ASSERT_EQ(hit.kind, HitKind::hit) << size;
      EXPECT_NEAR(hit.t * size, arc, 1e-12) << size;
    } else {
      EXPECT_EQ(hit.kind, HitKind::miss) << size;  // t does not exist in double
    }
  }
  Ray late = ray({0, 0, 3}, {0, 0, -1});
  late.tnear = infinity;
  EXPECT_EQ(scene.closest(late).kind, HitKind::miss);
  late.tnear = 1e300;
  EXPECT_EQ(scene.closest(late).kind, HitKind::miss);
  EXPECT_EQ(scene.occluded(late), HitKind::miss);
  EXPECT_EQ(scene.closest(ray({0, 0, 1e18}, {1, 0, 0})).kind, HitKind::miss);
}

TEST(InvalidRays, NoneReachesASetTooFarAway) {
  for (const double away : {1e20, 1e34, 1e36, 1e100, 1e290, 1.7e308}) {
    const std::vector<Vec3> corners{{0, 0, away}, {0, 1, away}, {1, 0, away}, {1, 1, away}};
    const PatchSet set = set_of({value_of(BezierPatch::polynomial(1, 1, corners))});
    const RayScene scene = scene_of(set, 3);
    std::vector<Ray> rays;
    for (const Vec3& direction : {Vec3{0, 0, 1}, Vec3{-1.25, -0.25, 1.5}, Vec3{0, 0, -1}, Vec3{1, 0, 1e-17}})
      for (const double origin : {0.5, 1e18, -1e18}) rays.push_back(ray({0.5, 0.5, origin}, direction));
    for (const Hit& hit : closest(scene, rays)) EXPECT_NE(hit.kind, HitKind::invalid_ray) << away;
    for (const Ray& one : rays)
      if (away > 1e35) {
        EXPECT_EQ(scene.closest(one).kind, HitKind::miss) << away;
        EXPECT_EQ(scene.occluded(one), HitKind::miss) << away;
      }
  }
}

TEST(RayBatches, EmptyAndShortBuffers) {
  const PatchSet set = set_of(sphere());
  const RayScene scene = scene_of(set);
  EXPECT_TRUE(scene.closest(std::span<const Ray>{}, std::span<Hit>{}).ok());
  EXPECT_TRUE(scene.occluded(std::span<const Ray>{}, std::span<std::uint8_t>{}).ok());
  const std::vector<Ray> rays(5, ray({0, 0, 3}, {0, 0, -1}));
  std::vector<Hit> hits(4);
  EXPECT_EQ(scene.closest(rays, hits).code(), StatusCode::buffer_too_small);
  for (const Hit& hit : hits) EXPECT_EQ(hit.kind, HitKind::miss);
  std::vector<std::uint8_t> occluded(4, 7);
  EXPECT_EQ(scene.occluded(rays, occluded).code(), StatusCode::buffer_too_small);
  for (const std::uint8_t value : occluded) EXPECT_EQ(value, 7);
  hits.resize(9);  // more room than rays: the rest is left alone
  hits[5].patch = 77;
  EXPECT_TRUE(scene.closest(rays, hits).ok());
  EXPECT_EQ(hits[4].kind, HitKind::hit);
  EXPECT_EQ(hits[5].patch, 77u);
}

TEST(RayOptions, OutOfRange) {
  const PatchSet set = set_of(sphere());
  for (const int rate : {0, -1, 4097, std::numeric_limits<int>::max()}) {
    RaySceneOptions options;
    options.mode = RayMode::grid;
    options.rate = rate;
    EXPECT_EQ(RayScene::make(set, options).status().code(), StatusCode::invalid_argument) << rate;
  }
  const PatchSet point = set_of(placed(sphere(), 0, {1, 2, 3}));
  EXPECT_EQ(RayScene::make(point).status().code(), StatusCode::unsupported);
  const std::atomic<bool> cancel = true;
  Execution execution;
  execution.cancel = &cancel;
  EXPECT_EQ(RayScene::make(set, {}, execution).status().code(), StatusCode::cancelled);
}

// A cancelled call leaves empty lists, also where it was cancelled between two of its tasks.
TEST(InvalidRays, CancelledListsAreEmpty) {
  const PatchSet set = set_of(Torus(4).patches(false));
  const RayScene scene = value_of(RayScene::make(set));
  const std::vector<Ray> rays = rays_through(set.box(), 5000, 3);
  std::atomic<bool> cancel = false;
  Execution execution;
  execution.cancel = &cancel;
  execution.progress = [&](double) { cancel = true; };
  HitLists lists;
  ASSERT_TRUE(scene.all(rays, lists).ok());
  EXPECT_EQ(scene.all(rays, lists, execution).code(), StatusCode::cancelled);
  EXPECT_TRUE(lists.hits.empty());
  EXPECT_TRUE(lists.first.empty());
}

}}  // namespace tessera::test
