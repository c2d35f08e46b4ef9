// Hits lie in the domains that their headers state, also where rays meet borders: other calls take their parameters.

#include <vector>

#include "ray/gaping_shapes.h"
#include "ray/lattice_body.h"
#include "support/seam_rays.h"
#include "support/solid_rays.h"

namespace tessera::test { namespace {

std::vector<Ray> rays_at_borders(const std::vector<BezierPatch>& patches, const PatchSet& set, std::size_t count,
                                 Random& random) {
  std::vector<Ray> rays;
  while (rays.size() < count) {
    const Vec3 eye = set.box().centre() + uniform(random, 0.6, 1.6) * set.box().diagonal() * rays::unit_vector(random);
    rays.push_back(ray(eye, beside_seam(patches, random, 0).position - eye));
  }
  return rays;
}

/// Counts hits that lie outside, or that other calls refuse.
std::size_t count_refused(const RayScene& scene, const PatchSet& set, const std::vector<Hit>& hits) {
  std::size_t refused = 0;
  for (const Hit& hit : hits) {
    if (hit.kind != HitKind::hit) continue;
    const bool is_inside =
        Domain{}.contains(hit.patch_u, hit.patch_v) && set.source(hit.patch).domain.contains(hit.u, hit.v);
    refused += !is_inside || !scene.local_geometry(hit).ok();
  }
  return refused;
}

void expect_none_refused(const RayScene& scene, const PatchSet& set, const std::vector<Ray>& rays,
                         bool has_all = true) {
  EXPECT_EQ(count_refused(scene, set, closest(scene, rays)), 0u);
  if (!has_all) return;
  HitLists lists;
  ASSERT_TRUE(scene.all(rays, lists).ok());
  EXPECT_GT(lists.hits.size(), rays.size());
  EXPECT_EQ(count_refused(scene, set, lists.hits), 0u);
}

TEST(HitDomain, RaysAtBorders) {
  for (const LatticeBody& body :
       {LatticeBody{3, 1, 0}, LatticeBody{3, 1, 0.2}, LatticeBody{2, 2, 0}, LatticeBody{2, 3, 0}}) {
    SCOPED_TRACE(body.degree);
    Random random(31);
    for (int k = 0; k < 4; ++k) {
      const std::vector<BezierPatch> patches = lattice_body(body, random);
      const PatchSet set = set_of(patches);
      const RayScene exact = value_of(RayScene::make(set));
      const std::vector<Ray> rays = rays_at_borders(patches, set, 10000, random);
      expect_none_refused(exact, set, rays);
      if (k > 0) continue;
      const RayInstance instances[] = {{&exact, Affine::translated({0, 0, 0})}};
      expect_none_refused(value_of(RayScene::make(instances)), set, rays);
      expect_none_refused(scene_of(set), set, rays, false);
      expect_none_refused(scene_of(set, 8, false), set, rays, false);
    }
  }
}

// The root next to a point of a border is on the border at most.
TEST(HitDomain, ResolvedRoots) {
  Random random(32);
  const std::vector<BezierPatch> patches = lattice_body({3, 1, 0.2}, random);
  const PatchSet set = set_of(patches);
  const RayScene scene = value_of(RayScene::make(set));
  std::vector<Hit> hits;
  for (const Ray& at : rays_at_borders(patches, set, 5000, random)) {
    const Hit hit = scene.closest(at);
    if (hit.kind == HitKind::hit) hits.push_back(value_of(scene.resolve(at, hit.patch, hit.patch_u, hit.patch_v)));
  }
  EXPECT_GT(hits.size(), 4000u);
  EXPECT_EQ(count_refused(scene, set, hits), 0u);
}

TEST(HitDomain, EdgesOfShapes) {
  const Shape shape = FrayedCube({1e-3}, 7).shape();
  const PatchSet set = value_of(make_patch_set(shape));
  const RayScene scene = value_of(RayScene::make(set));
  Random random(33);
  const EdgeTargets targets(shape);
  std::vector<Ray> rays;
  for (int k = 0; k < 5000; ++k) {
    const Vec3 eye = Vec3{0.5, 0.5, 0.5} + 3 * normalized(random_direction(random));
    rays.push_back(ray(eye, targets.draw(random) - eye));
  }
  EXPECT_EQ(count_refused(scene, set, closest(scene, rays)), 0u);
}

}}  // namespace tessera::test
