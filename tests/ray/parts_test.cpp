// Parts of a model, each in a scene of its own with the model's box: together they return the hits of the whole scene.

#include <algorithm>
#include <limits>

#include "ray_support.h"
#include "support/seam_rays.h"
#include "support/torus.h"

namespace tessera::test { namespace {

struct Part {
  std::vector<std::uint32_t> whole;  ///< index in the whole, by index in the part
  std::size_t own = 0;
  PatchSet set;
  RayScene scene;
};

bool share_per_corner(const BezierPatch& a, const BezierPatch& b) {
  const auto corners = [](const BezierPatch& patch) {
    const int m = patch.degree_u(), n = patch.degree_v();
    return std::array{patch.point(0, 0), patch.point(0, n), patch.point(m, 0), patch.point(m, n)};
  };
  for (const Vec3& p : corners(a)) {
    for (const Vec3& q : corners(b)) {
      if (p == q) return true;
    }
  }
  return false;
}

/// Makes `count` parts, patch by patch in turn; with neighbours at the end or without.
std::vector<Part> parts_of(const std::vector<BezierPatch>& patches, const Box3& box, std::size_t count,
                           bool with_neighbours) {
  std::vector<Part> out;
  for (std::size_t part = 0; part < count; ++part) {
    std::vector<std::uint32_t> whole;
    std::vector<BezierPatch> own;
    for (std::uint32_t k = 0; k < patches.size(); ++k) {
      if (k * count / patches.size() == part) whole.push_back(k), own.push_back(patches[k]);
    }
    const std::size_t own_count = own.size();
    for (std::uint32_t k = 0; k < patches.size() && with_neighbours; ++k) {
      const bool is_own = std::find(whole.begin(), whole.end(), k) != whole.end();
      const auto touches = [&](const BezierPatch& patch) { return share_per_corner(patch, patches[k]); };
      if (!is_own && std::any_of(own.begin(), own.begin() + static_cast<std::ptrdiff_t>(own_count), touches))
        whole.push_back(k), own.push_back(patches[k]);
    }
    PatchSet set = set_of(own);
    RaySceneOptions options;
    options.box = box;
    if (with_neighbours) options.patches = own_count;
    RayScene scene = value_of(RayScene::make(set, options));
    out.push_back({std::move(whole), own_count, std::move(set), std::move(scene)});
  }
  return out;
}

std::vector<std::vector<BezierPatch>> models() {
  return {Torus(8).patches(false), Torus(7).patches(true), sphere(), closed_body()};
}

std::vector<Ray> rays_at(const std::vector<BezierPatch>& patches, double size, std::size_t count) {
  Random random(91);
  std::vector<Ray> rays;
  for (std::size_t k = 0; k < count; ++k) {
    if (k % 3 == 0) rays.push_back(rays::at_surface(patches, random, size));
    if (k % 3 == 1) rays.push_back(rays::at_seam(patches, random, size));
    if (k % 3 == 2)
      rays.push_back(through(beside_seam(patches, random, rays::power(random, 1e-15, 1e-3)), random, size));
  }
  return rays;
}

TEST(Parts, TheNearestHitIsThatOfTheWhole) {
  for (const std::vector<BezierPatch>& patches : models()) {
    const PatchSet set = set_of(patches);
    const RayScene scene = value_of(RayScene::make(set));
    const std::vector<Ray> rays = rays_at(patches, set.box().diagonal(), 25000);
    const std::vector<Hit> expected = closest(scene, rays);
    std::vector<double> nearest(rays.size(), Hit{}.t);
    std::vector<bool> same(rays.size());
    for (const Part& part : parts_of(patches, set.box(), 3, false)) {
      const std::vector<Hit> hits = closest(part.scene, rays);
      for (std::size_t k = 0; k < rays.size(); ++k) {
        const Hit &hit = hits[k], &whole = expected[k];
        if (hit.kind != HitKind::hit) continue;
        nearest[k] = std::min(nearest[k], hit.t);
        if (part.whole[hit.patch] == whole.patch && hit.t == whole.t)
          same[k] = hit.patch_u == whole.patch_u && hit.patch_v == whole.patch_v && hit.position == whole.position &&
                    hit.normal == whole.normal && hit.residual == whole.residual;
      }
    }
    std::size_t hits = 0;
    for (std::size_t k = 0; k < rays.size(); ++k) {
      ASSERT_EQ(nearest[k], expected[k].t) << k;
      hits += expected[k].kind == HitKind::hit;
      EXPECT_EQ(same[k], expected[k].kind == HitKind::hit) << k;
    }
    EXPECT_GT(hits, rays.size() / 2);
  }
}

/// With neighbours, a root at a border belongs to only one part.
TEST(Parts, AllHitsAreThoseOfTheWhole) {
  for (const std::vector<BezierPatch>& patches : models()) {
    const PatchSet set = set_of(patches);
    const RayScene scene = value_of(RayScene::make(set));
    const std::vector<Ray> rays = rays_at(patches, set.box().diagonal(), 5000);
    HitLists expected;
    ASSERT_TRUE(scene.all(rays, expected).ok());
    std::vector<std::vector<std::pair<double, std::uint32_t>>> found(rays.size());
    for (const Part& part : parts_of(patches, set.box(), 3, true)) {
      HitLists lists;
      ASSERT_TRUE(part.scene.all(rays, lists).ok());
      for (std::size_t k = 0; k < rays.size(); ++k) {
        for (std::size_t h = lists.first[k]; h < lists.first[k + 1]; ++h) {
          ASSERT_LT(lists.hits[h].patch, part.own);
          found[k].push_back({lists.hits[h].t, part.whole[lists.hits[h].patch]});
        }
      }
    }
    for (std::size_t k = 0; k < rays.size(); ++k) {
      std::sort(found[k].begin(), found[k].end());
      ASSERT_EQ(found[k].size(), expected.first[k + 1] - expected.first[k]) << k;
      for (std::size_t h = 0; h < found[k].size(); ++h)
        EXPECT_EQ(found[k][h].first, expected.hits[expected.first[k] + h].t) << k;
    }
  }
}

/// Rays pass through neighbours, but these know a ray's origin.
TEST(Parts, NeighboursAreNotHit) {
  const std::vector<BezierPatch> patches = Torus(8).patches(false);
  const PatchSet set = set_of(patches);
  const RayScene scene = value_of(RayScene::make(set));
  const std::vector<Part> parts = parts_of(patches, set.box(), 3, true);
  Random random(92);
  std::size_t again = 0, beyond = 0;
  for (int k = 0; k < 6000; ++k) {
    const SeamPlace place = beside_seam(patches, random, rays::power(random, 1e-15, 1e-6));
    Ray out = leaving(scene, place, random);
    out.tfar = 1e-6;
    for (const Part& part : parts)
      again += part.scene.occluded(out) == HitKind::hit || part.scene.closest(out).kind == HitKind::hit;
  }
  EXPECT_EQ(again, 0u);
  for (const Part& part : parts) {
    const std::vector<Ray> rays = rays_at(patches, set.box().diagonal(), 3000);
    const std::vector<Hit> hits = closest(part.scene, rays);
    for (std::size_t k = 0; k < rays.size(); ++k) {
      beyond += hits[k].kind == HitKind::hit && hits[k].patch >= part.own;
      EXPECT_EQ(hits[k].kind, part.scene.occluded(rays[k]));
      EXPECT_EQ(hits[k].t, part.scene.closest(rays[k]).t);
    }
  }
  EXPECT_EQ(beyond, 0u);
}

TEST(Parts, EditsStayInTheBox) {
  PatchSet set = set_of(Torus(5).patches(false));
  const auto with = [](const Vec3& lower, const Vec3& upper) {
    RaySceneOptions options;
    options.box = Box3{lower, upper};
    return options;
  };
  RayScene scene = value_of(RayScene::make(set, with({-3, -3, -3}, {3, 3, 3})));
  Ray down = ray({0.8, 0.1, 2}, {0, 0, -1});
  const double before = scene.closest(down).t;
  std::vector<Vec3> points(set.patch(0).points().begin(), set.patch(0).points().end());
  for (Vec3& p : points) p.z += 0.25;
  ASSERT_TRUE(set.set_control_points(0, points).ok());
  ASSERT_TRUE(scene.refit().ok());
  EXPECT_NE(scene.closest(down).kind, HitKind::invalid_ray);
  EXPECT_TRUE(std::isfinite(before));
  for (Vec3& p : points) p.z += 5;
  ASSERT_TRUE(set.set_control_points(0, points).ok());
  EXPECT_EQ(scene.refit().code(), StatusCode::invalid_argument);
  EXPECT_EQ(scene.closest(down).kind, HitKind::invalid_ray);
}

TEST(Parts, BadOptions) {
  const PatchSet set = set_of(sphere());
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  RaySceneOptions options;
  for (const Box3& box : {Box3{}, Box3{{-1, -1, -1}, {1, 1, 0.999}}, Box3{{-1, nan, -1}, {1, 1, 1}}}) {
    options.box = box;
    EXPECT_EQ(RayScene::make(set, options).status().code(), StatusCode::invalid_argument);
  }
  options.box = Box3{{-infinity, -1, -1}, {infinity, 1, 1}};
  EXPECT_EQ(RayScene::make(set, options).status().code(), StatusCode::unsupported);
  options.box.reset();
  options.patches = 9;
  EXPECT_EQ(RayScene::make(set, options).status().code(), StatusCode::invalid_argument);
  options.patches = 0;  // neighbours alone
  const RayScene none = value_of(RayScene::make(set, options));
  EXPECT_EQ(none.closest(ray({0, 0, 3}, {0, 0, -1})).kind, HitKind::miss);
}

}}  // namespace tessera::test
