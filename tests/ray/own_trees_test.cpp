// The library's own trees give the hits of Embree's, to the bit.

#include <bit>
#include <cstdint>

#include "ray/frayed_scene.h"
#include "ray/tree/ray_trees.h"
#include "ray_support.h"
#include "support/torus.h"
#include "support/with_trees.h"
#include "tess_trim/trimmed_face.h"
#include "tessera/bezier_operations.h"

namespace tessera::test { namespace {

/// A scene of each kind of trees.
struct TreePair {
  explicit TreePair(const std::function<RayScene()>& make)
      : own([&] {
          const WithTrees with(own_ray_trees());
          return make();
        }()),
        embree([&] {
          const WithTrees with(preferred_ray_trees());
          return make();
        }()) {}
  explicit TreePair(const PatchSet& set, const RaySceneOptions& options = {})
      : TreePair([&] { return value_of(RayScene::make(set, options)); }) {}

  RayScene own, embree;
};

std::uint64_t bits(double x) { return std::bit_cast<std::uint64_t>(x); }
std::array<std::uint64_t, 3> bits(const Vec3& v) { return {bits(v.x), bits(v.y), bits(v.z)}; }

/// Compares everything but the number of steps, which depends on the leaves that are looked at in vain.
void trees_expect_same(const Hit& a, const Hit& b) {
  ASSERT_EQ(a.kind, b.kind);
  if (a.kind != HitKind::hit) return;
  EXPECT_EQ(a.instance, b.instance);
  EXPECT_EQ(a.patch, b.patch);
  EXPECT_EQ(bits(a.t), bits(b.t));
  EXPECT_EQ(bits(a.patch_u), bits(b.patch_u));
  EXPECT_EQ(bits(a.patch_v), bits(b.patch_v));
  EXPECT_EQ(bits(a.position), bits(b.position));
  EXPECT_EQ(bits(a.normal), bits(b.normal));
  EXPECT_EQ(bits(a.du), bits(b.du));
  EXPECT_EQ(bits(a.dv), bits(b.dv));
  EXPECT_EQ(bits(a.residual), bits(b.residual));
  EXPECT_EQ(a.flags.edge, b.flags.edge);
  EXPECT_EQ(a.flags.uncertified, b.flags.uncertified);
  EXPECT_EQ(a.flags.tangential, b.flags.tangential);
  EXPECT_EQ(a.flags.degenerate_normal, b.flags.degenerate_normal);
}

/// Returns the number of hits of all kinds of queries.
std::size_t expect_same_hits(const TreePair& pair, const std::vector<Ray>& rays) {
  const std::vector<Hit> hits = closest(pair.own, rays), expected = closest(pair.embree, rays);
  std::vector<std::uint8_t> occluded(rays.size()), dark(rays.size());
  EXPECT_TRUE(pair.own.occluded(rays, occluded).ok() && pair.embree.occluded(rays, dark).ok());
  EXPECT_EQ(occluded, dark);
  HitLists lists, all_expected;
  EXPECT_TRUE(pair.own.all(rays, lists).ok() && pair.embree.all(rays, all_expected).ok());
  EXPECT_EQ(lists.first, all_expected.first);
  std::size_t met = 0;
  for (std::size_t k = 0; k < rays.size(); ++k) {
    SCOPED_TRACE(k);
    trees_expect_same(hits[k], expected[k]);
    trees_expect_same(pair.own.closest(rays[k]), expected[k]);
    met += hits[k].kind == HitKind::hit;
  }
  for (std::size_t k = 0; k < std::min(lists.hits.size(), all_expected.hits.size()); ++k)
    trees_expect_same(lists.hits[k], all_expected.hits[k]);
  return met;
}

/// A camera's rays in rows, which are traced in packets, then random ones.
std::vector<Ray> rays_of_cameras(const Box3& box) {
  std::vector<Ray> rays;
  const Vec3 target = box.centre();
  for (const Vec3& from : {Vec3{1, -0.8, 0.6}, Vec3{-0.1, 0.9, -0.4}}) {
    const Vec3 eye = target + box.diagonal() * from, x = normalized(cross(target - eye, {0, 0, 1}));
    const Vec3 y = normalized(cross(x, target - eye));
    for (int row = 0; row < 48; ++row)
      for (int column = 0; column < 64; ++column) {
        const Vec3 aside = (0.0045 * box.diagonal()) * ((column - 32) * x + 2.5 * (row - 24) * y);
        rays.push_back(ray(eye, target - eye + aside));
      }
  }
  for (const Ray& random : rays_through(box, 2000, 91)) rays.push_back(random);
  return rays;
}

TEST(OwnTrees, HitsOfPatchesOfAnyKind) {
  std::vector<BezierPatch> quartic;
  for (const BezierPatch& patch : Torus(5).patches(false)) quartic.push_back(value_of(elevate_degree(patch, 4, 4)));
  for (const auto& patches : {Torus(12).patches(false), Torus(7).patches(true), quartic}) {
    const PatchSet set = set_of(patches);
    EXPECT_GT(expect_same_hits(TreePair(set), rays_of_cameras(set.box())), 2000u);
  }
}

TEST(OwnTrees, HitsOfEdgesAndOfCutFaces) {
  const Frayed cube;
  const TreePair edges(cube.set);
  EXPECT_GT(expect_same_hits(edges, cube.at_edges(2000, 5)), 1000u);
  EXPECT_GT(expect_same_hits(edges, rays_of_cameras(cube.set.box())), 1000u);
  const Face face(plane(), {circle_loop(2, 1.5, 0.9, false)});
  EXPECT_GT(expect_same_hits(TreePair(face.set), rays_of_cameras(face.set.box())), 200u);
}

TEST(OwnTrees, HitsAfterARefit) {
  const std::vector<BezierPatch> patches = Torus(8).patches(false);
  PatchSet set = set_of(patches);
  TreePair pair(set, {.editable = true});
  Random random(5);
  for (int round = 0; round < 4; ++round) {
    for (int edit = 0; edit < 12; ++edit) {
      const std::size_t k = random() % patches.size();
      std::vector<Vec3> points(set.patch(k).points().begin(), set.patch(k).points().end());
      for (Vec3& p : points) p += 0.2 * uniform_vector(random, -1, 1);
      ASSERT_TRUE(set.set_control_points(k, points).ok());
    }
    ASSERT_TRUE(pair.own.refit().ok());
    ASSERT_TRUE(pair.embree.refit().ok());
    EXPECT_GT(expect_same_hits(pair, rays_of_cameras(set.box())), 1000u);
  }
}

TEST(OwnTrees, HitsOfInstances) {
  const PatchSet set = set_of(Torus(8).patches(false));
  const TreePair scenes(set);
  const auto place = [](const RayScene& scene, std::size_t count) {
    std::vector<RayInstance> instances;
    Random random(17);
    for (std::size_t k = 0; k < count; ++k) {
      const double angle = uniform(random, 0, 6), size = uniform(random, 0.3, 0.6);
      instances.push_back({&scene, Affine::translated(2 * uniform_vector(random, -1, 1)) *
                                       Affine::rotated(random_direction(random), angle) *
                                       Affine::scaled({size, -size, 0.7 * size})});
    }
    return value_of(RayScene::make(instances));
  };
  for (const std::size_t count : {1u, 2u, 30u}) {
    TreePair placed([&] { return place(scenes.embree, count); });
    EXPECT_GT(expect_same_hits(placed, rays_of_cameras(placed.own.box())), 100u);
    {
      const WithTrees with(own_ray_trees());
      placed.own = place(scenes.own, count);
    }
    EXPECT_GT(expect_same_hits(placed, rays_of_cameras(placed.own.box())), 100u);
  }
}

// Facets are met in float by Embree and in double by the library's own trees, so that few rays meet others.
TEST(OwnTrees, HitsOfGrids) {
  const PatchSet set = set_of(Torus(8).patches(true));
  const std::vector<Ray> rays = rays_of_cameras(set.box());
  for (const int rate : {1, 7, 8}) {
    for (const bool refine : {false, true}) {
      const TreePair pair(set, {.mode = RayMode::grid, .rate = rate, .refine = refine});
      const std::vector<Hit> hits = closest(pair.own, rays), expected = closest(pair.embree, rays);
      std::vector<std::uint8_t> occluded(rays.size());
      ASSERT_TRUE(pair.own.occluded(rays, occluded).ok());
      std::size_t met = 0, differ = 0, dark = 0;
      for (std::size_t k = 0; k < rays.size(); ++k) {
        differ += hits[k].kind != expected[k].kind;
        dark += (occluded[k] != 0) != (hits[k].kind == HitKind::hit);
        if (hits[k].kind != HitKind::hit || expected[k].kind != HitKind::hit) continue;
        ++met;
        const double sine = std::abs(dot(expected[k].normal, normalized(rays[k].direction)));
        const double off = refine && !hits[k].flags.unrefined ? 1e-9 : 1e-4;
        if (sine > 0.05)
          differ += length(hits[k].position - expected[k].position) * sine > off ||
                    hits[k].patch != expected[k].patch || std::abs(hits[k].u - expected[k].u) > 1e-3 ||
                    std::abs(hits[k].v - expected[k].v) > 1e-3;
      }
      EXPECT_GT(met, 2000u);
      EXPECT_LE(differ, met / 200) << rate << refine;
      EXPECT_LE(dark, met / 20);  // facets decide
    }
  }
}

}}  // namespace tessera::test
