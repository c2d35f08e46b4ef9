// Rays that leave a surface: the point that they leave is never hit again, its neighbours always are. Also checks the
// other values of a hit: derivatives, curvature, cost.

#include <algorithm>
#include <cmath>

#include "ray_support.h"
#include "support/torus.h"

namespace tessera::test { namespace {

Ray leaving(const RayScene& scene, const Vec3& from, const Vec3& direction) {
  Ray out = ray(from, direction);
  out.spawn_offset = scene.spawn_offset();
  return out;
}

/// A point of a patch: inside, on an edge, at a corner.
std::pair<double, double> place(Random& random, int kind) {
  const double u = uniform(random, 0, 1), v = uniform(random, 0, 1);
  if (kind % 4 == 1) return {std::round(u), v};
  if (kind % 4 == 2) return {u, std::round(v)};
  if (kind % 4 == 3) return {std::round(u), std::round(v)};
  return {u, v};
}

/// Outwards nothing is hit, however flat the angle; inwards the sphere's other side, where the chord ends. Includes
/// corners, borders and poles.
TEST(Spawn, LeavingASphere) {
  for (const Vec3& centre : {Vec3{}, Vec3{100, -30, 7}}) {
    const PatchSet set = set_of(placed(sphere(), 1, centre));
    const RayScene scene = value_of(RayScene::make(set));
    Random random(71);
    for (int k = 0; k < 3000; ++k) {
      const auto [u, v] = place(random, k);
      const Hit from = value_of(scene.resolve(static_cast<std::uint32_t>(random() % set.patch_count()), u, v));
      const Vec3 out = normalized(from.position - centre), along = normalized(cross(out, random_direction(random)));
      const double sine = std::pow(10, uniform(random, -9, 0));
      const Vec3 direction = std::sqrt(1 - sine * sine) * along + sine * out;
      EXPECT_EQ(scene.closest(leaving(scene, from.position, direction)).kind, HitKind::miss) << k << " " << sine;
      EXPECT_EQ(scene.occluded(leaving(scene, from.position, direction)), HitKind::miss);
      if (sine < 1e-5) continue;  // the chord is no deeper than the tolerance
      const Vec3 inwards = direction - 2 * sine * out;
      const Hit other = scene.closest(leaving(scene, from.position, inwards));
      ASSERT_EQ(other.kind, HitKind::hit) << k << " " << sine;
      // The tolerance, and the rounding of the origin, move a chord's end by that over its angle.
      EXPECT_NEAR(other.t, 2 * sine, 1e-11 * (1 + max_abs(centre) / 100) / sine) << k;
      EXPECT_EQ(scene.occluded(leaving(scene, from.position, inwards)), HitKind::hit);
    }
  }
}

/// From one point of a hollow to another one near by, both on the surface: the second is hit, at t = 1.
TEST(Spawn, NeighboursInAHollowAreMet) {
  for (const bool is_rational : {false, true}) {
    const PatchSet set = set_of(Torus(12).patches(is_rational));
    const RayScene scene = value_of(RayScene::make(set));
    Random random(72);
    std::size_t met = 0;
    for (int k = 0; k < 8000; ++k) {
      const auto patch = static_cast<std::uint32_t>(random() % set.patch_count());
      const auto [u, v] = place(random, k);
      const double step = std::pow(10, uniform(random, -5, -1)), angle = uniform(random, 0, 6.3);
      const double to_u = u + step * std::cos(angle), to_v = v + step * std::sin(angle);
      if (std::min(to_u, to_v) < 0 || std::max(to_u, to_v) > 1) continue;
      const Hit from = value_of(scene.resolve(patch, u, v)), to = value_of(scene.resolve(patch, to_u, to_v));
      const Vec3 chord = to.position - from.position;
      // The chord's bend, by the normals at both ends: it leaves the surface and comes back.
      const double dip = dot(from.normal, normalized(chord)), rise = dot(to.normal, normalized(chord));
      if (std::abs(dip) * length(chord) < 1e-10 || dip * rise > -0.3 * dip * dip) continue;
      const Hit hit = scene.closest(leaving(scene, from.position, chord));
      ++met;
      ASSERT_EQ(hit.kind, HitKind::hit) << k << " " << step;
      EXPECT_LT(std::abs(hit.t - 1) * length(chord) * std::abs(dip), 1e-11) << k << " " << step;
    }
    EXPECT_GT(met, 500u);
  }
}

/// Through a scene with many folds: the closest hits equal all hits, less the one at the start.
TEST(Spawn, LeavesOneRootOut) {
  const PatchSet set = set_of(wavy_field(6, 6));
  const RayScene scene = value_of(RayScene::make(set));
  Random random(73);
  std::size_t hits = 0;
  for (int k = 0; k < 5000; ++k) {
    const auto [u, v] = place(random, k);
    const Hit from = value_of(scene.resolve(static_cast<std::uint32_t>(random() % set.patch_count()), u, v));
    const Vec3 direction = normalized(random_direction(random));
    if (std::abs(dot(direction, from.normal)) < 1e-3) continue;
    Ray around = ray(from.position - 1e-3 * direction, direction);
    HitLists lists;
    ASSERT_TRUE(scene.all({&around, 1}, lists).ok());
    std::erase_if(lists.hits, [](const Hit& hit) { return hit.t < 1e-3 + 1e-9; });
    const Ray out = leaving(scene, from.position, direction);
    HitLists own;
    ASSERT_TRUE(scene.all({&out, 1}, own).ok());
    ASSERT_EQ(own.hits.size(), lists.hits.size()) << k;
    for (std::size_t j = 0; j < own.hits.size(); ++j) EXPECT_NEAR(own.hits[j].t, lists.hits[j].t - 1e-3, 1e-9);
    const Hit first = scene.closest(out);
    EXPECT_EQ(first.kind == HitKind::hit, !own.hits.empty());
    EXPECT_EQ(first.t, own.hits.empty() ? Hit{}.t : own.hits[0].t);
    hits += own.hits.size();
  }
  EXPECT_GT(hits, 500u);
}

TEST(Spawn, InPlanesAndInstances) {
  std::vector<Vec3> flat{{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}};
  const PatchSet plane = set_of({polynomial(1, 1, flat)});
  const RayScene floor = value_of(RayScene::make(plane));
  for (const double slope : {1e-12, 1e-9, 1e-3, 1.0}) {
    for (const double sign : {-1.0, 1.0}) {
      const Vec3 from{0.3, 0.4, 0};
      EXPECT_EQ(floor.closest(leaving(floor, from, {0.5, 0.3, sign * slope})).kind, HitKind::miss) << slope;
    }
  }
  EXPECT_EQ(floor.closest(leaving(floor, {0.3, 0.4, 0}, {0.5, 0.3, 0})).kind, HitKind::miss);

  const PatchSet ball = set_of(sphere());
  const RayScene one = value_of(RayScene::make(ball));
  const std::vector<RayInstance> two{{&one, Affine::scaled({2, 1, -0.5})}, {&one, Affine::translated({0, 0, 7})}};
  const RayScene scene = value_of(RayScene::make(two));
  Random random(74);
  for (int k = 0; k < 3000; ++k) {
    const Vec3 start{uniform(random, -1, 1), uniform(random, -0.5, 0.5), -9};
    const Hit first = scene.closest(ray(start, {0, 0, 1}));
    if (first.kind != HitKind::hit) continue;
    const Hit second = scene.closest(leaving(scene, first.position, {0, 0, 1}));
    ASSERT_EQ(second.kind, HitKind::hit);
    EXPECT_EQ(second.instance, 0u);
    EXPECT_NEAR(second.t, -2 * first.position.z, 1e-12);
    EXPECT_EQ(scene.closest(leaving(scene, first.position, {0, 0, -1})).kind, HitKind::miss);
  }
}

TEST(Spawn, BadOffsets) {
  const PatchSet set = set_of(sphere());
  const RayScene scene = value_of(RayScene::make(set));
  for (const double offset : {-1.0, 1e300, std::numeric_limits<double>::quiet_NaN()}) {
    Ray down = ray({0, 0, 3}, {0, 0, -1});
    down.spawn_offset = offset;
    EXPECT_EQ(scene.closest(down).kind, HitKind::invalid_ray);
  }
}

TEST(HitFacts, DerivativesAreThoseOfTheSurface) {
  const std::vector<BezierPatch> patches = Torus(6).patches(true);
  std::vector<PatchSource> sources(patches.size(), {3, {.u0 = 1, .u1 = 1.5, .v0 = -2, .v1 = 6}});
  const PatchSet set = value_of(PatchSet::make(patches, {.sources = sources}));
  const Affine map = Affine::rotated({1, 1, 0}, 1) * Affine::scaled({-2, 1, 3});
  for (const RayMode mode : {RayMode::exact, RayMode::grid}) {
    const RayScene scene = value_of(RayScene::make(set, {.mode = mode}));
    Random random(75);
    for (int k = 0; k < 300; ++k) {
      const Vec3 target = uniform_vector(random, -1, 1), origin = 4.0 * normalized(random_direction(random));
      const Ray at = ray(origin, Vec3{target.x, target.y, 0.3 * target.z} - origin);
      const Hit hit = scene.closest(at);
      if (hit.kind != HitKind::hit || hit.flags.unrefined) continue;
      const SurfaceJet jet = evaluate_jet(patches[hit.patch], hit.patch_u, hit.patch_v);
      EXPECT_LT(length(hit.du - 2 * jet.du), 2e-8 * length(jet.du));
      EXPECT_LT(length(hit.dv - 0.125 * jet.dv), 2e-8 * length(jet.dv));
      const LocalGeometry geometry = value_of(scene.local_geometry(hit));
      const LocalGeometry expected = local_geometry(patches[hit.patch], hit.patch_u, hit.patch_v);
      EXPECT_EQ(geometry.gaussian, expected.gaussian);
      EXPECT_EQ(geometry.first.direction, expected.first.direction);
      if (mode == RayMode::grid) continue;
      const RayInstance placed{&scene, map};
      const RayScene there = value_of(RayScene::make({&placed, 1}));
      const Hit moved = there.closest(ray(map.point(at.origin), map.vector(at.direction)));
      ASSERT_EQ(moved.kind, HitKind::hit);
      EXPECT_LT(length(moved.du - map.vector(hit.du)), 1e-9 * length(moved.du));
      EXPECT_LT(length(moved.normal - normalized(cross(moved.du, moved.dv))), 1e-9);
    }
  }
}

TEST(HitFacts, CurvatureOfInstances) {
  const PatchSet set = set_of(sphere());
  const RayScene ball = value_of(RayScene::make(set));
  const double a = 3, b = 0.5, c = 2;
  const RayInstance placed{&ball, Affine::scaled({a, b, -c})};
  const RayScene scene = value_of(RayScene::make({&placed, 1}));
  Random random(76);
  for (int k = 0; k < 500; ++k) {
    const Hit hit = scene.closest(ray(5.0 * normalized(random_direction(random)), {}));
    EXPECT_EQ(hit.kind, HitKind::invalid_ray);
    const Vec3 origin = 5.0 * normalized(random_direction(random));
    const Hit met = scene.closest(ray(origin, -origin));
    ASSERT_EQ(met.kind, HitKind::hit);
    // An ellipsoid's Gaussian curvature: (abc (x^2/a^4 + y^2/b^4 + z^2/c^4))^-2 (do Carmo, sec. 3.3).
    const Vec3& p = met.position;
    const double sum = p.x * p.x / (a * a * a * a) + p.y * p.y / (b * b * b * b) + p.z * p.z / (c * c * c * c);
    const double expected = 1 / std::pow(a * b * c * sum, 2);
    const LocalGeometry geometry = value_of(scene.local_geometry(met));
    if (!geometry.defined) continue;  // a pole
    EXPECT_NEAR(geometry.gaussian, expected, 1e-6 * expected);
    EXPECT_LT(length(geometry.normal.direction - met.normal), 1e-7);
  }
  EXPECT_EQ(scene.local_geometry(Hit{}).status().code(), StatusCode::invalid_argument);
  Hit elsewhere;
  elsewhere.kind = HitKind::hit;
  EXPECT_EQ(scene.local_geometry(elsewhere).status().code(), StatusCode::invalid_argument);
  elsewhere.patch = 99;
  EXPECT_EQ(ball.local_geometry(elsewhere).status().code(), StatusCode::invalid_argument);
}

TEST(HitFacts, ResolvingFromFloats) {
  const PatchSet set = set_of(Torus(8).patches(false));
  const RayScene scene = value_of(RayScene::make(set));
  Random random(77);
  for (int k = 0; k < 1000; ++k) {
    const Vec3 target = uniform_vector(random, -1, 1), origin = 3.0 * normalized(random_direction(random));
    const Ray at = ray(origin, Vec3{target.x, target.y, 0.3 * target.z} - origin);
    const Hit hit = scene.closest(at);
    if (hit.kind != HitKind::hit || std::abs(dot(hit.normal, normalized(at.direction))) < 0.05) continue;
    const float u = static_cast<float>(hit.patch_u), v = static_cast<float>(hit.patch_v);
    const Hit near = value_of(scene.resolve(hit.patch, u, v));
    EXPECT_LT(length(near.position - hit.position), 1e-6);
    EXPECT_LT(length(near.normal - hit.normal), 1e-6);
    const Hit polished = value_of(scene.resolve(at, hit.patch, u, v));
    EXPECT_NEAR(polished.t, hit.t, 1e-13);
    EXPECT_FALSE(polished.flags.unrefined);
    EXPECT_LT(length(polished.position - hit.position), 1e-13);
  }
  EXPECT_TRUE(value_of(scene.resolve(ray({0, 0, 3}, {0, 0.01, -1}), 0, 0.5, 0.5)).flags.unrefined);
  EXPECT_EQ(scene.resolve(64, 0.5, 0.5).status().code(), StatusCode::invalid_argument);
  EXPECT_EQ(scene.resolve(0, -0.1, 0.5).status().code(), StatusCode::invalid_argument);
  EXPECT_EQ(scene.resolve(ray({}, {}), 0, 0.5, 0.5).status().code(), StatusCode::invalid_argument);
  EXPECT_EQ(scene_of(set).resolve(ray({0, 0, 3}, {0, 0, -1}), 0, 0.5, 0.5).status().code(), StatusCode::unsupported);
}

TEST(HitFacts, TouchingAndCost) {
  const PatchSet set = set_of(sphere());
  const RayScene scene = value_of(RayScene::make(set));
  const Hit touch = scene.closest(ray({1 + 1e-13, 0.1, 3}, {0, 0, -1}));
  EXPECT_EQ(touch.kind, HitKind::miss);
  const Hit plain = scene.closest(ray({0.1, 0.2, 3}, {0, 0, -1}));
  EXPECT_FALSE(plain.flags.tangential || plain.flags.within_tolerance);
  EXPECT_GE(plain.steps, 1);
  EXPECT_EQ(scene.closest(ray({9, 9, 9}, {1, 0, 0})).steps, 0);
  Random random(78);
  std::size_t touched = 0, costly = 0;
  for (int k = 0; k < 2000; ++k) {
    const Vec3 out = normalized(random_direction(random)), along = normalized(cross(out, random_direction(random)));
    const Hit hit = scene.closest(ray((1 - 1e-14) * out - 2.0 * along, along));
    costly += hit.steps > plain.steps;
    if (hit.kind != HitKind::hit || !hit.flags.uncertified) continue;
    ++touched;
    EXPECT_TRUE(hit.flags.tangential || hit.flags.degenerate_normal);
  }
  EXPECT_GT(touched, 100u);
  EXPECT_GT(costly, 100u);
}

}}  // namespace tessera::test
