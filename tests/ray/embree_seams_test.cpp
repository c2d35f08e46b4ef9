// Rays at the borders of patches in the user's Embree scene: none passes where the ray scene itself has a hit.

#include <cmath>

#include "embree_world.h"
#include "ray/lattice_body.h"
#include "support/ray_classes.h"

namespace tessera::test { namespace {

struct Disagreements {
  std::size_t lost = 0, dark = 0, moved = 0, hits = 0;
};

/// Compares rays from a distance at borders with the scene's own hits.
Disagreements compare(const std::vector<BezierPatch>& patches, const RayScene& scene, RTCScene in, double distance,
                      std::size_t count) {
  Random random(61);
  Disagreements out;
  for (std::size_t k = 0; k < count; ++k) {
    const Vec3 at = beside_seam(patches, random, 0).position, eye = at + distance * rays::unit_vector(random);
    const Vec3 from = in_float(ray(eye, {})).origin;
    const Ray aimed = in_float(ray(from, at - from));
    const Hit expected = scene.closest(aimed);
    const RTCRayHit found = trace(in, aimed);
    if (expected.kind != HitKind::hit) continue;
    ++out.hits;
    out.lost += found.hit.geomID == nothing;
    out.dark += !is_occluded(in, aimed);
    out.moved += found.ray.tfar != static_cast<float>(expected.t);
  }
  return out;
}

// Embree ignores the flag for user geometries, so it makes no difference.
TEST(EmbreeSeams, NoRayPassesThem) {
  Random random(62);
  for (const double noise : {0.0, 0.2}) {
    const std::vector<BezierPatch> patches = lattice_body({3, 3, noise}, random);
    const PatchSet set = set_of(patches);
    const RayScene scene = value_of(RayScene::make(set));
    for (const bool robust : {false, true}) {
      const World world;
      rtcSetSceneFlags(world.scene.get(), robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);
      ASSERT_TRUE(attach(scene, world.scene.get()).ok());
      rtcCommitScene(world.scene.get());
      for (const double distance : {1.5, 3.0, 50.0, 2000.0, 40000.0}) {
        SCOPED_TRACE(distance);
        const Disagreements found = compare(patches, scene, world.scene.get(), distance, 10000);
        EXPECT_GT(found.hits, 8000u);
        EXPECT_EQ(found.lost, 0u);
        EXPECT_EQ(found.dark, 0u);
        EXPECT_EQ(found.moved, 0u);
      }
    }
  }
}

// Far from zero, Embree's products with the origin round by more than the padding of pieces.
TEST(EmbreeSeams, FarFromZero) {
  Random random(63);
  const std::vector<BezierPatch> patches = placed(lattice_body({3, 3, 0}, random), 1, {3000, -2000, 500});
  const PatchSet set = set_of(patches);
  const RayScene scene = value_of(RayScene::make(set));
  const World world;
  ASSERT_TRUE(attach(scene, world.scene.get()).ok());
  rtcCommitScene(world.scene.get());
  const Disagreements found = compare(patches, scene, world.scene.get(), 3, 20000);
  EXPECT_GT(found.hits, 15000u);
  EXPECT_EQ(found.lost + found.dark + found.moved, 0u);
}

}}  // namespace tessera::test
