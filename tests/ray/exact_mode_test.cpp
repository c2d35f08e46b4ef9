// Exact mode besides its hits: ends of rays, bad rays and options, edits, several hits, degenerate sets.

#include <limits>

#include "ray_support.h"

namespace tessera::test { namespace {

RaySceneOptions exact_options() {
  RaySceneOptions options;
  options.mode = RayMode::exact;
  return options;
}
RayScene exact_scene(const PatchSet& set) { return value_of(RayScene::make(set, exact_options())); }

/// All hits of one ray.
std::vector<Hit> all_of(const RayScene& scene, const Ray& one) {
  HitLists lists;
  const Status status = scene.all({&one, 1}, lists);
  EXPECT_TRUE(status.ok()) << status.message();
  return lists.hits;
}

TEST(ExactMode, SphereInClosedForm) {
  const PatchSet set = set_of(sphere());
  const RayScene scene = exact_scene(set);
  Random random(41);
  for (int k = 0; k < 2000; ++k) {
    const Vec3 target = 0.95 * random_direction(random), direction = 3.0 * normalized(random_direction(random));
    const Ray one = ray(target - direction, direction);
    // |o + t d|^2 = 1.
    const double a = dot(direction, direction), b = dot(one.origin, direction), c = dot(one.origin, one.origin) - 1;
    const double root = std::sqrt(b * b - a * c), first = c / (-b + root), second = (-b + root) / a;
    const std::vector<Hit> hits = all_of(scene, one);
    ASSERT_EQ(hits.size(), 2u);
    EXPECT_NEAR(hits[0].t, first, 2e-14 / root * 3);
    EXPECT_NEAR(hits[1].t, second, 2e-14 / root * 3);
    const Hit hit = scene.closest(one);
    EXPECT_EQ(hit.t, hits[0].t);
    EXPECT_FALSE(hit.flags.uncertified || hit.flags.unrefined || hit.flags.incomplete);
    EXPECT_LT(length(hit.position - (one.origin + hit.t * direction)), 1e-13);
    EXPECT_LT(std::min(length(hit.normal - hit.position), length(hit.normal + hit.position)), 1e-7);
    EXPECT_LT(hit.residual, 1e-14);
  }
}

TEST(ExactMode, EndsOfTheRayAreKept) {
  const PatchSet set = set_of(sphere());
  const RayScene scene = exact_scene(set);
  Ray one = ray({0.1, 0.2, 3}, {0, 0, -1});
  const std::vector<Hit> hits = all_of(scene, one);
  ASSERT_EQ(hits.size(), 2u);
  const double first = hits[0].t, second = hits[1].t, infinity = std::numeric_limits<double>::infinity();
  const auto closest_between = [&](double from, double to) {
    one.tnear = from, one.tfar = to;
    const Hit hit = scene.closest(one);
    EXPECT_EQ(scene.occluded(one), hit.kind);
    return hit.t;
  };
  EXPECT_EQ(closest_between(first, infinity), first);
  EXPECT_EQ(closest_between(std::nextafter(first, 10), infinity), second);
  EXPECT_EQ(closest_between(0, first), first);
  EXPECT_EQ(closest_between(0, std::nextafter(first, 0)), infinity);
  EXPECT_EQ(closest_between(second, second), second);
  EXPECT_EQ(closest_between(std::nextafter(second, 10), infinity), infinity);
}

TEST(ExactMode, SharedPointsAreOneHit) {
  const PatchSet set = set_of(sphere());
  const RayScene scene = exact_scene(set);
  EXPECT_EQ(all_of(scene, ray({0, 0, 3}, {0, 0, -1})).size(), 2u);     // both poles, four patches each
  EXPECT_EQ(all_of(scene, ray({3, 0, 0}, {-1, 0, 0})).size(), 2u);     // corners of four patches
  EXPECT_EQ(all_of(scene, ray({3, 0, 0.25}, {-1, 0, 0})).size(), 2u);  // borders
  EXPECT_EQ(all_of(scene, ray({0.3, 0.4, 3}, {0, 0, -1})).size(), 2u);
  const PatchSet twice = set_of({closed_body()[0], closed_body()[0]});
  const Vec3 target = de_casteljau(closed_body()[0], 0.3, 0.6);
  const RayScene both = exact_scene(twice);
  const std::vector<Hit> hits = all_of(both, ray(3.0 * target, -target));
  ASSERT_EQ(hits.size(), 2u);  // two patches at one place are two hits
  EXPECT_NE(hits[0].patch, hits[1].patch);
  EXPECT_EQ(hits[0].t, hits[1].t);
}

TEST(ExactMode, DenormalEndsOfTheRayAreKept) {
  const std::vector<Vec3> corners{{-1, -1, 0}, {-1, 1, 0}, {1, -1, 0}, {1, 1, 0}};
  const PatchSet set = set_of({value_of(BezierPatch::polynomial(1, 1, corners))});
  const RayScene scene = exact_scene(set);
  const std::vector<double> small{0, 5e-324, 1e-310, 2.3e-308, 1e-300, 1e-20};
  std::vector<Ray> rays;
  for (const double z : small)
    for (const double dz : {-4.0, -1.0, 1.0})
      for (const double sideways : {0.0, 5e-324, 0.5})
        for (const double near : small)
          for (const double far : {near, 2 * near, 1.0}) {
            rays.push_back(ray({0.3, 0.4, z}, {sideways, 0, dz}));
            rays.back().tnear = near, rays.back().tfar = far;
          }
  const std::vector<Hit> hits = closest(scene, rays);
  std::size_t met = 0;
  for (std::size_t k = 0; k < rays.size(); ++k) {
    std::vector<Hit> found = all_of(scene, rays[k]);
    EXPECT_EQ(scene.occluded(rays[k]) == HitKind::hit, !found.empty()) << k;
    found.push_back(scene.closest(rays[k])), found.push_back(hits[k]);
    for (const Hit& hit : found) {
      if (hit.kind != HitKind::hit) continue;
      ++met;
      EXPECT_GE(hit.t, rays[k].tnear) << k;
      EXPECT_LE(hit.t, rays[k].tfar) << k;
    }
  }
  EXPECT_GT(met, 100u);
}

TEST(ExactMode, BadRaysAreMissesOfTheirOwnKind) {
  const PatchSet set = set_of(sphere());
  const RayScene scene = exact_scene(set);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<Ray> bad(6, ray({0, 0, 3}, {0, 0, -1}));
  bad[0].origin.y = nan, bad[1].direction = {}, bad[2].tnear = -1, bad[3].tfar = nan, bad[4].direction.x = 1e300;
  bad[5].tnear = 3, bad[5].tfar = 2;
  for (const Ray& one : bad) {
    EXPECT_EQ(scene.closest(one).kind, HitKind::invalid_ray);
    EXPECT_EQ(scene.occluded(one), HitKind::invalid_ray);
    EXPECT_TRUE(all_of(scene, one).empty());
  }
}

TEST(ExactMode, TinyAndHugeDirections) {
  const PatchSet set = set_of(sphere());
  const RayScene scene = exact_scene(set);
  for (const double length : {1e-300, 1e-30, 1.0, 1e18}) {
    const Hit hit = scene.closest(ray({0.3, 0.4, 3}, {0, 0, -length}));
    ASSERT_EQ(hit.kind, HitKind::hit) << length;
    EXPECT_NEAR(hit.t * length, 3 - std::sqrt(0.75), 1e-14);
  }
  EXPECT_EQ(scene.closest(ray({0, 0, 1e18}, {0, 0, -1})).kind, HitKind::hit);
  EXPECT_EQ(scene.closest(ray({2, 0, 1e18}, {0, 0, -1})).kind, HitKind::miss);
  EXPECT_EQ(scene.closest(ray({0.3, 0.4, 3}, {0, 0, -5e-324})).kind, HitKind::miss);  // no t in double reaches it
}

TEST(ExactMode, ToleranceAndPiecesAreChecked) {
  const PatchSet set = set_of(sphere());
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double tolerance : {0.0, -1e-9, infinity, std::numeric_limits<double>::quiet_NaN()}) {
    RaySceneOptions options = exact_options();
    options.tolerance = tolerance;
    EXPECT_EQ(RayScene::make(set, options).status().code(), StatusCode::invalid_argument) << tolerance;
  }
  for (const int pieces : {0, -1, 3, 16}) {
    RaySceneOptions options = exact_options();
    options.pieces = pieces;
    EXPECT_EQ(RayScene::make(set, options).status().code(), StatusCode::invalid_argument) << pieces;
  }
}

TEST(ExactMode, HitsLieWithinTheTolerance) {
  const PatchSet set = set_of(sphere());
  const RayScene sharp = exact_scene(set);
  for (const double tolerance : {1e-3, 1e-6, 1e-9}) {
    RaySceneOptions options = exact_options();
    options.tolerance = tolerance;
    const RayScene scene = value_of(RayScene::make(set, options));
    Random random(43);
    for (int k = 0; k < 500; ++k) {
      const double off = uniform(random, -3, 3) * tolerance;
      const Vec3 n = normalized(random_direction(random)), d = normalized(cross(n, random_direction(random)));
      const Ray one = ray((1 + off) * n - 3.0 * d, d);
      const Hit hit = scene.closest(one);
      EXPECT_TRUE(hit.kind == HitKind::hit || sharp.closest(one).kind == HitKind::miss);
      EXPECT_LE(hit.residual, 1.0001 * tolerance);
    }
  }
}

TEST(ExactMode, EditsMakeStaleUntilRefit) {
  PatchSet set = set_of({closed_body()[0]});
  RayScene scene = exact_scene(set);
  const Vec3 target = de_casteljau(set.patch(0), 0.4, 0.7);
  const Ray one = ray(3.0 * target, -target);
  const double before = scene.closest(one).t;
  std::vector<Vec3> points(set.patch(0).points().begin(), set.patch(0).points().end());
  for (Vec3& p : points) p = p + 0.1 * target;
  ASSERT_TRUE(set.set_control_points(0, points).ok());
  EXPECT_EQ(scene.closest(one).kind, HitKind::invalid_ray);
  HitLists lists;
  EXPECT_EQ(scene.all({&one, 1}, lists).code(), StatusCode::stale);
  ASSERT_TRUE(scene.refit().ok());
  EXPECT_NEAR(scene.closest(one).t, before - 0.1, 1e-13);
  const RayScene grid = scene_of(set);
  EXPECT_EQ(grid.all({&one, 1}, lists).code(), StatusCode::unsupported);
}

TEST(ExactMode, DegenerateSets) {
  const std::vector<Vec3> line{{0, 0, 0}, {0, 0, 0}, {1, 0, 0}, {1, 0, 0}}, point(4, Vec3{1, 1, 1});
  const PatchSet lines =
      set_of({polynomial(1, 1, line), polynomial(1, 1, {{0, 1, 0}, {0.5, 1, 0}, {0.5, 1, 0}, {1, 1, 0}}),
              polynomial(1, 1, point)});
  const RayScene scene = exact_scene(lines);
  EXPECT_EQ(scene.closest(ray({0.5, 0, 2}, {0, 0, -1})).kind, HitKind::hit);  // across the lines
  EXPECT_EQ(scene.closest(ray({0.25, 1, 2}, {0, 0, -1})).kind, HitKind::hit);
  EXPECT_EQ(scene.closest(ray({0.25, 0.5, 2}, {0, 0, -1})).kind, HitKind::miss);
  EXPECT_EQ(scene.closest(ray({1, 1, 2}, {0, 0, -1})).kind, HitKind::hit);  // the point
  EXPECT_EQ(scene.closest(ray({-1, 0, 0}, {1, 0, 0})).t, 1);                // along a line
  const PatchSet nothing = set_of({polynomial(1, 1, point)});
  EXPECT_EQ(RayScene::make(nothing, exact_options()).status().code(), StatusCode::unsupported);
}

TEST(ExactMode, AnswersDoNotDependOnThreadsOrBatches) {
  const PatchSet set = set_of(closed_body());
  const RayScene scene = exact_scene(set);
  Random random(42);
  std::vector<Ray> rays;
  for (int k = 0; k < 3000; ++k) rays.push_back(ray(2.0 * random_direction(random), random_direction(random)));
  const std::vector<Hit> hits = closest(scene, rays);
  std::vector<std::uint8_t> occluded(rays.size());
  ASSERT_TRUE(scene.occluded(rays, occluded).ok());
  for (std::size_t k = 0; k < rays.size(); ++k) {
    const Hit one = scene.closest(rays[k]);
    EXPECT_EQ(one.kind, hits[k].kind);
    EXPECT_EQ(one.t, hits[k].t);
    EXPECT_EQ(one.patch_u, hits[k].patch_u);
    EXPECT_EQ(occluded[k] != 0, one.kind == HitKind::hit);
  }
}

}}  // namespace tessera::test
