// The renderer that engine/docs/renderer.md builds: its shadow rays leave seams of patches at grazing angles, neither
// meet the surface that they leave nor slip through it.

// The guide's program. Its main function has another name, and so must not end without a value.
#define main guide_main
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wreturn-type"
#include "renderer_guide.h"
#pragma GCC diagnostic pop
#undef main

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>

#include "support/random_patches.h"

namespace tessera::test { namespace {

/// The guide's world, and the same surfaces in a scene of instances, in double.
struct GuideWorld {
  GuideWorld() {
    value_or_throw(attach(surfaces, one));
    rtcCommitScene(one);
    for (const Affine& map : world.maps) {
      add_instance(device, world.scene, one, map);
      placed.push_back({&surfaces, map});
    }
    for (const RTCScene scene : {world.scene, triangles}) {
      add_triangles(device, scene);
      rtcCommitScene(scene);
    }
    instances = std::make_unique<RayScene>(value_or_throw(RayScene::make(placed)));
  }
  ~GuideWorld() {
    for (const RTCScene scene : {one, world.scene, triangles}) rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }
  GuideWorld(const GuideWorld&) = delete;
  GuideWorld& operator=(const GuideWorld&) = delete;

  PatchSet set = value_or_throw(make_patch_set(model_of(nullptr)));
  RayScene surfaces = value_or_throw(RayScene::make(set));
  RTCDevice device = rtcNewDevice("start_threads=0");
  RTCScene one = make_scene(device), triangles = make_scene(device);
  World world{
      surfaces,
      {Affine::translated({-2.6, 0, -0.65}), Affine::translated({0, 0.4, 0.3}) * Affine::rotated({1, 0, 0}, 1.2),
       Affine::translated({2.7, 0.6, 0}) * Affine::scaled({1, 1, 2.4})},
      make_scene(device)};
  std::vector<RayInstance> placed;
  std::unique_ptr<RayScene> instances;
};

/// A point of a patch in an instance, as the guide's look() returns one: on an edge or a corner of the patch.
Point seam_point(const GuideWorld& guide, Random& random) {
  EmbreeOrigin origin;
  origin.geometry = 0, origin.instance[0] = static_cast<unsigned>(random() % guide.world.maps.size());
  origin.patch = static_cast<unsigned>(random() % guide.set.patch_count());
  origin.u = uniform(random, 0, 1), origin.v = uniform(random, 0, 1);
  const unsigned kind = static_cast<unsigned>(random() % 4);
  if (kind != 1) origin.u = std::round(origin.u);
  if (kind != 2) origin.v = std::round(origin.v);
  if (kind == 3) origin.u = std::abs(origin.u - 1e-8);  // beside the seam, nearer than float can tell
  const Affine& map = guide.world.maps[origin.instance[0]];
  const Hit at = value_or_throw(guide.surfaces.resolve(origin.patch, origin.u, origin.v));
  const Vec3 normal = normalized(cross(map.vector(at.du), map.vector(at.dv)));
  return {.met = true, .on_surface = true, .position = map.point(at.position), .normal = normal, .origin = origin};
}

/// Whether the ray is dark in double. Nothing where a change of its direction by 1e-5 decides otherwise: float rounds
/// rays in instances.
std::optional<bool> expected_dark(const GuideWorld& guide, const Point& from, const Vec3& light) {
  const World triangles{guide.surfaces, {}, guide.triangles};
  std::optional<bool> dark;
  for (const double turn : {-1e-5, 0.0, 1e-5}) {
    Ray ray{.origin = from.position, .direction = light + turn * from.normal};
    ray.spawn_offset = guide.instances->spawn_offset();
    const bool now = guide.instances->occluded(ray) == HitKind::hit || is_dark(triangles, from, ray.direction);
    if (dark && *dark != now) return {};
    dark = now;
  }
  return dark;
}

TEST(RendererGuide, ShadowRaysFromSeamsAtGrazingAngles) {
  const GuideWorld guide;
  Random random(91);
  std::size_t dark = 0, lit = 0, self_hits = 0, leaks = 0, into_itself = 0;
  for (int k = 0; k < 30000; ++k) {
    const Point from = seam_point(guide, random);
    const Vec3 along = normalized(cross(from.normal, uniform_vector(random, -1, 1)));
    const double sine = std::pow(10, uniform(random, -4, 0)) * (k % 2 == 0 ? 1 : -1);
    const Vec3 light = along + sine * from.normal;
    const std::optional<bool> expected = expected_dark(guide, from, light);
    if (!expected) continue;
    const bool found = is_dark(guide.world, from, light);
    (*expected ? dark : lit) += 1;
    self_hits += found && !*expected, leaks += !found && *expected;
    Point without = from;
    without.origin = {};
    into_itself += !*expected && is_dark(guide.world, without, light);
  }
  EXPECT_EQ(self_hits, 0u);
  EXPECT_EQ(leaks, 0u);
  EXPECT_GT(dark, 5000u);
  EXPECT_GT(lit, 2000u);
  EXPECT_GT(into_itself, 500u) << "without origins, rays meet the surface that they leave";
}

}}  // namespace tessera::test
