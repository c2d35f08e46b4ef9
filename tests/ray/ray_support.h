#pragma once
// Sets and scenes for the tests of rays.

#include <gtest/gtest.h>

#include <vector>

#include "support/random_patches.h"
#include "support/synthetic_sets.h"
#include "tessera/patch_set.h"
#include "tessera/ray_scene.h"

namespace tessera::test {

inline PatchSet set_of(const std::vector<BezierPatch>& patches) { return value_of(PatchSet::make(patches)); }

inline RayScene scene_of(const PatchSet& set, int rate = 8, bool refine = true) {
  RaySceneOptions options;
  options.mode = RayMode::grid;
  options.rate = rate;
  options.refine = refine;
  return value_of(RayScene::make(set, options));
}

inline Ray ray(const Vec3& origin, const Vec3& direction) {
  Ray out;
  out.origin = origin;
  out.direction = direction;
  return out;
}

inline std::vector<Hit> closest(const RayScene& scene, const std::vector<Ray>& rays) {
  std::vector<Hit> hits(rays.size());
  const Status status = scene.closest(rays, hits);
  EXPECT_TRUE(status.ok()) << status.message();
  return hits;
}

inline std::vector<Hit> all_hits(const RayScene& scene, const Ray& ray) {
  HitLists lists;
  EXPECT_TRUE(scene.all({&ray, 1}, lists).ok());
  return lists.hits;
}

inline Vec3 random_direction(Random& random) {
  for (;;) {
    const Vec3 v = uniform_vector(random, -1, 1);
    if (dot(v, v) <= 1 && dot(v, v) > 1e-4) return v;
  }
}

/// From a sphere around the box through the box.
inline std::vector<Ray> rays_through(const Box3& box, std::size_t count, std::uint64_t seed) {
  Random random(seed);
  std::vector<Ray> rays;
  for (std::size_t k = 0; k < count; ++k) {
    const Vec3 half = 0.5 * (box.upper - box.lower), in = uniform_vector(random, -1, 1);
    const Vec3 origin = box.centre() + box.diagonal() * normalized(random_direction(random));
    rays.push_back(ray(origin, box.centre() + Vec3{half.x * in.x, half.y * in.y, half.z * in.z} - origin));
  }
  return rays;
}

}  // namespace tessera::test
