// Instances: the same hits as for patches whose control points are mapped, for any map.

#include <algorithm>
#include <cmath>
#include <limits>

#include "ray_support.h"
#include "support/torus.h"

namespace tessera::test { namespace {

BezierPatch mapped(const BezierPatch& patch, const Affine& map) {
  std::vector<Vec3> points;
  for (const Vec3& p : patch.points()) points.push_back(map.point(p));
  return value_of(patch.with_points(points));
}

RayScene instances_of(const RayScene& scene, const std::vector<Affine>& maps) {
  std::vector<RayInstance> instances;
  for (const Affine& map : maps) instances.push_back({&scene, map});
  return value_of(RayScene::make(instances));
}

void instance_expect_same(const Hit& hit, const Hit& expected, const Ray& of, double tolerance) {
  ASSERT_EQ(hit.kind, expected.kind);
  if (hit.kind != HitKind::hit) return;
  const double sine = std::abs(dot(expected.normal, normalized(of.direction)));
  if (sine < 1e-4) return;
  EXPECT_LT(std::abs(hit.t - expected.t) * length(of.direction) * sine, tolerance);
  EXPECT_LT(length(hit.position - expected.position) * sine, tolerance);
  EXPECT_LT(length(hit.normal - expected.normal) * sine, 1e-8);
  EXPECT_LT(hit.residual, tolerance);
}

/// Stretched, mirrored, turned, sheared, far away, tiny, huge.
std::vector<Affine> maps() {
  const Affine sheared{.columns = {Vec3{1, 0.3, 0}, Vec3{0.9, 1, -0.2}, Vec3{0, 0.5, 1}}, .translation = {1, 2, 3}};
  return {Affine{},
          Affine::scaled({3, 0.2, 1}),
          Affine::scaled({-1, 1, 1}),
          Affine::translated({5, -7, 2}) * Affine::rotated({1, 2, 3}, 1.1) * Affine::scaled({1, -2, 0.5}),
          sheared,
          Affine::translated({1e6, -1e6, 1e5}) * sheared,
          Affine::scaled({1e-20, 1e-20, 2e-20}),
          Affine::rotated({0, 1, 1}, 2) * Affine::scaled({1e15, 1e15, -1e15})};
}

TEST(Instances, HitsOfMappedPatches) {
  for (const bool is_rational : {false, true}) {
    const std::vector<BezierPatch> patches = Torus(8).patches(is_rational);
    const PatchSet set = set_of(patches);
    const RayScene scene = value_of(RayScene::make(set));
    for (const Affine& map : maps()) {
      const RayScene placed = instances_of(scene, {map});
      std::vector<BezierPatch> moved;
      for (const BezierPatch& patch : patches) moved.push_back(mapped(patch, map));
      PatchSetOptions options;
      options.blocks = {.float_bernstein = false, .double_bernstein = true};
      const PatchSet reference_set = value_of(PatchSet::make(moved, options));
      const RayScene reference = value_of(RayScene::make(reference_set));
      const Box3 box = reference_set.box();
      const double tolerance = 1e-11 * box.diagonal() + 1e-15 * max_abs(map.translation);
      const std::vector<Ray> rays = rays_through(box, 2000, 61);
      const std::vector<Hit> hits = closest(placed, rays), expected = closest(reference, rays);
      HitLists lists, all_expected;
      ASSERT_TRUE(placed.all(rays, lists).ok());
      ASSERT_TRUE(reference.all(rays, all_expected).ok());
      EXPECT_EQ(lists.first, all_expected.first);
      std::size_t met = 0;
      for (std::size_t k = 0; k < rays.size(); ++k) {
        instance_expect_same(hits[k], expected[k], rays[k], tolerance);
        EXPECT_EQ(placed.occluded(rays[k]), expected[k].kind);
        met += hits[k].kind == HitKind::hit;
        EXPECT_EQ(hits[k].instance, hits[k].kind == HitKind::hit ? 0 : Hit::no_instance);
      }
      EXPECT_GT(met, 300u);
    }
  }
}

TEST(Instances, ManyOfSeveralScenes) {
  const PatchSet balls = set_of(sphere()), rings = set_of(Torus(6).patches(false));
  const RayScene ball = value_of(RayScene::make(balls)), ring = value_of(RayScene::make(rings));
  Random random(62);
  std::vector<RayInstance> instances;
  for (int k = 0; k < 300; ++k) {
    const Vec3 size = uniform_vector(random, 0.2, 0.5);
    const Affine map = Affine::translated(uniform_vector(random, -5, 5)) *
                       Affine::rotated(random_direction(random), uniform(random, 0, 6)) * Affine::scaled(size);
    instances.push_back({k % 3 == 0 ? &ring : &ball, map});
  }
  const RayScene scene = value_of(RayScene::make(instances));
  std::vector<RayScene> alone;
  for (const RayInstance& one : instances) alone.push_back(value_of(RayScene::make({&one, 1})));
  const std::vector<Ray> rays = rays_through(scene.box(), 600, 63);
  HitLists lists;
  ASSERT_TRUE(scene.all(rays, lists).ok());
  std::size_t met = 0;
  for (std::size_t k = 0; k < rays.size(); ++k) {
    std::vector<std::pair<double, std::uint32_t>> expected;
    for (std::uint32_t j = 0; j < alone.size(); ++j) {
      HitLists own;
      ASSERT_TRUE(alone[j].all({&rays[k], 1}, own).ok());
      for (const Hit& hit : own.hits) expected.emplace_back(hit.t, j);
    }
    std::sort(expected.begin(), expected.end());
    const std::span<const Hit> hits =
        std::span(lists.hits).subspan(lists.first[k], lists.first[k + 1] - lists.first[k]);
    ASSERT_EQ(hits.size(), expected.size());
    for (std::size_t j = 0; j < hits.size(); ++j) {
      EXPECT_EQ(hits[j].t, expected[j].first);
      EXPECT_EQ(hits[j].instance, expected[j].second);
    }
    const Hit hit = scene.closest(rays[k]);
    EXPECT_EQ(scene.occluded(rays[k]) == HitKind::hit, !expected.empty());
    ASSERT_EQ(hit.kind == HitKind::hit, !expected.empty());
    if (expected.empty()) continue;
    EXPECT_EQ(hit.t, expected[0].first);
    EXPECT_EQ(hit.instance, expected[0].second);
    ++met;
  }
  EXPECT_GT(met, 200u);
}

TEST(Instances, NothingLeavesAClosedBody) {
  const PatchSet set = set_of(closed_body());
  const RayScene body = value_of(RayScene::make(set));
  for (const Affine& map : maps()) {
    const RayScene scene = instances_of(body, {map});
    Random random(64);
    std::size_t missed = 0;
    for (int k = 0; k < 4000; ++k) {
      const BezierPatch& patch = set.patch(random() % set.patch_count());
      const Vec3 inside = 0.3 * random_direction(random), border = de_casteljau(patch, k % 2, uniform(random, 0, 1));
      missed += scene.closest(ray(map.point(inside), map.vector(border - inside))).kind != HitKind::hit;
    }
    EXPECT_EQ(missed, 0u);
  }
}

TEST(Instances, FarOriginsAndEndsOfTheRay) {
  const PatchSet set = set_of(sphere());
  const RayScene ball = value_of(RayScene::make(set));
  const Affine map = Affine::translated({4, 5, 6}) * Affine::scaled({2, 1, 0.5});
  const RayScene scene = instances_of(ball, {map});
  const Vec3 target = map.point({0.3, 0.4, std::sqrt(0.75)});
  for (const double distance : {1.0, 1e7, 1e12}) {
    const Vec3 direction = normalized({0.1, -0.2, -1});
    const Ray from = ray(target - distance * direction, direction);
    const Hit hit = scene.closest(from);
    ASSERT_EQ(hit.kind, HitKind::hit);
    EXPECT_LT(length(hit.position - target), 1e-14 * std::max(100.0, 10 * distance));  // the origin's own rounding
    EXPECT_LT(hit.residual, 1e-14);
  }
  Ray down = ray({4.3, 5.2, 9}, {0, 0, -1});
  const double first = scene.closest(down).t;
  down.tnear = first;
  EXPECT_EQ(scene.closest(down).t, first);
  down.tnear = std::nextafter(first, 10);
  const double second = scene.closest(down).t;
  EXPECT_GT(second, first + 0.1);
  down.tfar = std::nextafter(second, 0);
  EXPECT_EQ(scene.closest(down).kind, HitKind::miss);
  EXPECT_EQ(scene.occluded(down), HitKind::miss);
  down.tfar = second;
  EXPECT_EQ(scene.occluded(down), HitKind::hit);
  down.tnear = -1;
  EXPECT_EQ(scene.closest(down).kind, HitKind::invalid_ray);
}

TEST(Instances, EditsMakeStaleUntilBothAreRefitted) {
  PatchSet set = set_of(sphere());
  RayScene ball = value_of(RayScene::make(set));
  RayScene scene = instances_of(ball, {Affine{}, Affine::translated({5, 0, 0})});
  RayScene moved = std::move(ball);  // the scene is unchanged
  const Ray down = ray({5.125, 0.25, 5}, {0, 0, -1});
  const double before = scene.closest(down).t;
  for (std::size_t k = 0; k < set.patch_count(); ++k) {
    std::vector<Vec3> points(set.patch(k).points().begin(), set.patch(k).points().end());
    for (Vec3& p : points) p.z += 3;
    ASSERT_TRUE(set.set_control_points(k, points).ok());
  }
  Hit hit;
  EXPECT_EQ(scene.closest({&down, 1}, {&hit, 1}).code(), StatusCode::stale);
  EXPECT_EQ(scene.refit().code(), StatusCode::stale);
  ASSERT_TRUE(moved.refit().ok());
  EXPECT_EQ(scene.closest({&down, 1}, {&hit, 1}).code(), StatusCode::stale);
  ASSERT_TRUE(scene.refit().ok());
  EXPECT_NEAR(scene.closest(down).t, before - 3, 1e-12);
}

TEST(Instances, RefusalsSayWhy) {
  const PatchSet set = set_of(sphere());
  const RayScene exact = value_of(RayScene::make(set)), grid = scene_of(set), nested = instances_of(exact, {Affine{}});
  const auto refusal = [&](const RayScene* scene, const Affine& map) {
    const std::vector<RayInstance> two{{&exact, Affine{}}, {scene, map}};
    const Status status = RayScene::make(two).status();
    EXPECT_EQ(status.index(), 1);
    return status.code();
  };
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(RayScene::make(std::span<const RayInstance>{}).status().code(), StatusCode::invalid_argument);
  EXPECT_EQ(refusal(nullptr, {}), StatusCode::invalid_argument);
  EXPECT_EQ(refusal(&grid, {}), StatusCode::unsupported);
  EXPECT_EQ(refusal(&nested, {}), StatusCode::unsupported);
  EXPECT_EQ(refusal(&exact, Affine::scaled({1, 0, 1})), StatusCode::invalid_argument);
  EXPECT_EQ(refusal(&exact, Affine::scaled({1, 1e-9, 1})), StatusCode::invalid_argument);
  EXPECT_EQ(refusal(&exact, Affine::scaled({1, nan, 1})), StatusCode::non_finite);
  EXPECT_EQ(refusal(&exact, Affine::translated({0, 1e308 * 10, 0})), StatusCode::non_finite);
}

}}  // namespace tessera::test
