// Grid mode over meshes that were made for other purposes.

#include "ray_support.h"
#include "support/reference_rays.h"
#include "support/torus.h"
#include "tessera/tessellation.h"

namespace tessera::test { namespace {

Mesh certified_mesh(const PatchSet& set, double tolerance, bool quads) {
  const auto plan = value_of(Tessellation::make(set, {.tolerance = tolerance, .quads = quads}));
  Mesh mesh = value_of(plan.allocate());
  const Status status = plan.run(set, mesh.views());
  EXPECT_TRUE(status.ok()) << status.message();
  return mesh;
}

/// Rates that differ from patch to patch: a torus that is thicker on one side.
std::vector<BezierPatch> uneven_torus() {
  std::vector<BezierPatch> out;
  for (const BezierPatch& patch : Torus(8).patches(false)) {
    std::vector<Vec3> points(patch.points().begin(), patch.points().end());
    for (Vec3& p : points) p.z *= 1 + 0.5 * p.x;
    out.push_back(value_of(BezierPatch::polynomial(3, 3, points)));
  }
  return out;
}

TEST(MeshScene, MeetsTheSurfaceOverTrianglesAndQuads) {
  const std::vector<BezierPatch> patches = uneven_torus();
  const PatchSet set = set_of(patches);
  const std::vector<Ray> rays = rays_through(set.box(), 4000, 5);
  for (const bool quads : {false, true}) {
    const Mesh mesh = certified_mesh(set, 1e-3 * set.box().diagonal(), quads);
    EXPECT_EQ(mesh.quad_count() > 0, quads);
    EXPECT_GT(mesh.triangle_count(), 0u);
    const RayScene scene = value_of(RayScene::make(set, mesh));
    const std::vector<Hit> hits = closest(scene, rays);
    std::vector<std::uint8_t> occluded(rays.size());
    ASSERT_TRUE(scene.occluded(rays, occluded).ok());
    std::size_t met = 0, differ = 0;
    for (std::size_t k = 0; k < rays.size(); ++k) {
      const ReferenceHit expected = reference_closest(patches, rays[k]);
      const bool hit = hits[k].kind == HitKind::hit;
      EXPECT_EQ(hit, occluded[k] != 0);
      met += hit && !hits[k].flags.unrefined;
      differ += hit != expected.hit() || (hit && !(std::abs(hits[k].t - expected.t) <= 1e-9));
    }
    EXPECT_GT(met, 1000u);
    EXPECT_LT(differ, rays.size() / 200);  // facets miss silhouettes
  }
}

TEST(MeshScene, FollowsTheMeshAfterAnEdit) {
  const std::vector<BezierPatch> patches = Torus(6).patches(false);
  PatchSet set = set_of(patches);
  const auto plan = value_of(Tessellation::make(set, {.tolerance = 1e-3}));
  Mesh mesh = value_of(plan.allocate());
  ASSERT_TRUE(plan.run(set, mesh.views()).ok());
  RayScene scene = value_of(RayScene::make(set, mesh));
  const std::vector<Ray> rays = rays_through(set.box(), 500, 6);
  const std::vector<Hit> before = closest(scene, rays);
  for (std::size_t k = 0; k < patches.size(); ++k) {
    std::vector<Vec3> points;
    for (const Vec3& p : patches[k].points()) points.push_back(p + Vec3{0, 0, 0.05});
    ASSERT_TRUE(set.set_control_points(k, points).ok());
  }
  std::vector<Hit> hits(rays.size());
  EXPECT_EQ(scene.closest(rays, hits).code(), StatusCode::stale);
  ASSERT_TRUE(plan.run(set, mesh.views()).ok());
  ASSERT_TRUE(scene.refit().ok());
  std::vector<Ray> moved = rays;
  for (Ray& ray : moved) ray.origin.z += 0.05;
  ASSERT_TRUE(scene.closest(moved, hits).ok());
  std::size_t met = 0;
  for (std::size_t k = 0; k < rays.size(); ++k) {
    EXPECT_EQ(hits[k].kind, before[k].kind);
    if (hits[k].kind != HitKind::hit || hits[k].flags.unrefined || before[k].flags.unrefined) continue;
    EXPECT_NEAR(hits[k].t, before[k].t, 1e-9);
    ++met;
  }
  EXPECT_GT(met, 100u);
}

TEST(MeshScene, BorrowsWhatHasRoom) {
  const PatchSet set = set_of(Torus(6).patches(false));
  Mesh mesh = certified_mesh(set, 1e-4, false);
  EXPECT_GT(mesh.positions.capacity(), mesh.positions.size()) << "what is allocated has room";
  const std::size_t borrowed = value_of(RayScene::make(set, mesh)).memory_bytes();
  mesh.positions.shrink_to_fit();
  const std::size_t copied = value_of(RayScene::make(set, mesh)).memory_bytes();
  EXPECT_GE(copied, borrowed + mesh.positions.size() * sizeof(float));
}

TEST(MeshScene, SaysWhatIsWrongWithAMesh) {
  const PatchSet set = set_of(Torus(6).patches(false));
  const Mesh good = certified_mesh(set, 1e-2, false);
  const auto refused = [&](const char* why, const auto& spoil, std::ptrdiff_t index,
                           StatusCode code = StatusCode::invalid_argument) {
    Mesh mesh = good;
    spoil(mesh);
    const Result<RayScene> scene = RayScene::make(set, mesh);
    ASSERT_FALSE(scene.ok()) << why;
    EXPECT_EQ(scene.status().code(), code) << why;
    EXPECT_EQ(scene.status().index(), index) << why;
  };
  refused(
      "no patches", [](Mesh& m) { m.patches.clear(); }, 0);
  refused(
      "no parameters", [](Mesh& m) { m.parameters.clear(); }, 0);
  refused(
      "nothing", [](Mesh& m) { m = Mesh{}; }, 0);
  refused(
      "another origin", [](Mesh& m) { m.origin.x += 1; }, 0);
  refused(
      "a position that is NaN", [](Mesh& m) { m.positions[3 * 7 + 1] = std::nanf(""); }, 7, StatusCode::non_finite);
  refused(
      "a parameter above 1", [](Mesh& m) { m.parameters[2 * 5] = 1.5f; }, 5);
  refused(
      "an index too many", [](Mesh& m) { m.indices[3 * 4 + 2] = 0xffffffff; }, 4);
  refused(
      "a patch too many", [](Mesh& m) { m.patches[3] = 36; }, 3);
  refused(
      "half a triangle", [](Mesh& m) { m.indices.pop_back(); }, 0);
}

}}  // namespace tessera::test
