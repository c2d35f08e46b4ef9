// Rays do not slip between the faces of closed shapes: edges are hits within their gaps.

#include <algorithm>
#include <cmath>
#include <vector>

#include "ray/batch_support.h"
#include "ray/frayed_scene.h"
#include "ray/gaping_shapes.h"
#include "support/solid_rays.h"

namespace tessera::test { namespace {

double widest(const RayScene& scene) {
  const std::vector<double> gaps = value_of(scene.edge_gaps());
  return gaps.empty() ? 0 : *std::ranges::max_element(gaps);
}

SolidTally cast(const Shape& shape, std::size_t rays, bool edges = true) {
  const PatchSet set = value_of(make_patch_set(shape));
  const RayScene scene = value_of(RayScene::make(set, RaySceneOptions{.edges = edges}));
  SolidRays solid(shape, scene, 3);
  EXPECT_GT(solid.inside_count(), 20u);
  solid.cast(rays);
  return solid.tally();
}

/// Casts rays at a closed shape: none leaks, and crossings have the right parity. Without tubes some leak.
void expect_tight(const Shape& shape, std::size_t rays = 20000) {
  ASSERT_TRUE(check_topology(shape).ok()) << check_topology(shape).message();
  ASSERT_TRUE(is_closed(shape));
  const SolidTally tally = cast(shape, rays);
  EXPECT_EQ(tally.leaks, 0u);
  EXPECT_EQ(tally.odd, 0u);
  EXPECT_EQ(tally.seam_odd, 0u);
  EXPECT_EQ(tally.unsure_odd, 0u);
  EXPECT_GT(tally.seams, rays / 10);
  EXPECT_LE(tally.unmoved, tally.seams / 500);
  EXPECT_LE(tally.unsure, rays / 20);
  const SolidTally open = cast(shape, rays, false);
  EXPECT_EQ(open.seams, 0u);
  EXPECT_GT(open.leaks, 0u);
  EXPECT_GT(open.odd, rays / 100);
}

TEST(EdgeTubes, FrayedCubesAreTight) {
  for (const bool open_corners : {false, true})
    for (const double size : {1e-2, 1e-3, 1e-6}) {
      SCOPED_TRACE(size);
      expect_tight(FrayedCube({size, open_corners}, 5).shape());
    }
}

// At each corner of the cube a triangle is missing.
TEST(EdgeTubes, CornersThatAreCutOffAreTight) { expect_tight(FrayedCube({1e-3, false, 0.01}, 5).shape()); }

TEST(EdgeTubes, DrilledPlatesAreTight) {
  for (const double gap : {1e-2, 1e-4, 1e-7}) expect_tight(gaping_plate(gap));
}

TEST(EdgeTubes, RoundSolidsWithSeamsAreTight) {
  for (const double gap : {1e-3, 1e-6}) {
    expect_tight(round_bar(gap));
    expect_tight(half_ball(gap));
  }
}

// The gap of an edge holds the distance of its faces, and is not much larger.
TEST(EdgeTubes, GapsAreTheDistancesOfFaces) {
  const double fray = 1e-3;
  const Shape shape = FrayedCube({fray}, 6).shape();
  const PatchSet set = value_of(make_patch_set(shape));
  const RayScene scene = value_of(RayScene::make(set));
  const std::vector<double> measured = value_of(edge_gaps(shape, 257)), gaps = value_of(scene.edge_gaps());
  ASSERT_EQ(gaps.size(), 12u);
  for (std::size_t k = 0; k < gaps.size(); ++k) {
    EXPECT_GE(gaps[k], measured[k]);
    EXPECT_LE(gaps[k], 4 * fray);
  }
}

// Faces that run along an edge at different paces are no farther apart for it.
TEST(EdgeTubes, GapsDoNotDependOnPaces) {
  const double fray = 1e-4;
  const Shape shape = FrayedCube({.size = fray, .pace = 0.1}, 9).shape();
  const PatchSet set = value_of(make_patch_set(shape));
  const RayScene scene = value_of(RayScene::make(set));
  const std::vector<double> at_equal_parameters = value_of(edge_gaps(shape, 65));
  EXPECT_GT(*std::ranges::max_element(at_equal_parameters), 100 * fray);
  EXPECT_LE(widest(scene), 4 * fray);
  expect_tight(shape);
}

// Curves that leave their planes' domains are cut off there. Lines along the borders of domains stand for them, also
// around corners.
TEST(EdgeTubes, CurvesThatLeaveTheirDomains) {
  for (const Fray& fray : {Fray{.size = 5e-4, .room = 0}, Fray{.size = 3e-4, .pace = 0.1, .room = 0}}) {
    SCOPED_TRACE(fray.size);
    const Shape shape = FrayedCube(fray, 10).shape();
    const PatchSet set = value_of(make_patch_set(shape));
    const RayScene scene = value_of(RayScene::make(set));
    EXPECT_LE(widest(scene), 4 * fray.size);
    SolidRays solid(shape, scene, 11);
    EXPECT_GT(solid.inside_count(), 20u);
    solid.cast(20000);
    EXPECT_GT(solid.tally().seams, 2000u);
    EXPECT_EQ(solid.tally().leaks, 0u);
    EXPECT_EQ(solid.tally().odd, 0u);
    EXPECT_EQ(solid.tally().seam_odd, 0u);
  }
}

// Borders of whole patches with equal control points need no tube, nor does a set without edges.
TEST(EdgeTubes, SharedBordersHaveNone) {
  const Shape shape = joined(cube(), 1e-6);
  const PatchSet set = value_of(make_patch_set(shape)), loose = set_of(closed_body());
  const RayScene scene = value_of(RayScene::make(set)), without = value_of(RayScene::make(loose));
  EXPECT_EQ(value_of(scene.edge_gaps()), std::vector<double>(12, 0.0));
  EXPECT_TRUE(value_of(without.edge_gaps()).empty());
  EXPECT_FALSE(scene.closest(ray({0.5, -1, 1}, {0, 1, 0})).flags.edge);
}

TEST(EdgeTubes, HitsAreTheNearestPointsOfLoops) {
  const Frayed cube;
  const double gap = widest(cube.scene);
  std::size_t seams = 0;
  for (const Ray& at : cube.at_edges(4000, 1)) {
    const Hit hit = cube.scene.closest(at);
    if (hit.kind != HitKind::hit || !hit.flags.edge) continue;
    ++seams;
    const Vec3 d = normalized(at.direction), from = hit.position - at.origin;
    const double off = length(from - dot(from, d) * d);
    EXPECT_LE(off, gap);
    EXPECT_NEAR(hit.residual, off, 1e-12);
    EXPECT_NEAR(dot(from, d), hit.t * length(at.direction), 1e-9);
    const Hit resolved = value_of(cube.scene.resolve(hit.patch, hit.patch_u, hit.patch_v));
    EXPECT_LE(length(resolved.position - hit.position), 1e-12);
    EXPECT_FALSE(hit.flags.uncertified);
  }
  EXPECT_GT(seams, 500u);
}

// A ray that passes an edge is moved aside, but not out of the body that it crosses, where one of the ways leads
// through it: 4 of these rays have none.
TEST(EdgeTubes, RaysAreNotMovedOffTheirHits) {
  const Frayed cube;
  const RayScene faces = value_of(RayScene::make(cube.set, RaySceneOptions{.edges = false}));
  const std::vector<Ray> rays = cube.at_edges(4000, 8);
  HitLists moved, unmoved;
  ASSERT_TRUE(cube.scene.all(rays, moved).ok());
  ASSERT_TRUE(faces.all(rays, unmoved).ok());
  std::size_t crossings = 0, lost = 0;
  for (std::size_t k = 0; k < rays.size(); ++k) {
    const std::size_t count = moved.first[k + 1] - moved.first[k], expected = unmoved.first[k + 1] - unmoved.first[k];
    lost += count < expected / 2 * 2;
    crossings += count > 0 && expected > 1 && moved.hits[moved.first[k]].flags.edge;
  }
  EXPECT_GT(crossings, 500u);
  EXPECT_LE(lost, crossings / 100);
}

// Packets, arrays of float, single rays and instances all see the same edges.
TEST(EdgeTubes, AllKindsOfCallsAgree) {
  const Frayed cube;
  const Arrays<float> arrays(cube.at_edges(4000, 2));
  const std::vector<Ray> rays = arrays.rays();
  Outputs<double> outputs(rays.size());
  ASSERT_TRUE(closest(cube.scene, arrays.views(), outputs.views()).ok());
  const std::vector<Hit> hits = closest(cube.scene, rays);
  std::vector<std::uint8_t> dark(rays.size());
  ASSERT_TRUE(cube.scene.occluded(rays, dark).ok());
  const RayInstance instances[] = {{&cube.scene, Affine::translated({0, 0, 0})}};
  const RayScene placed = value_of(RayScene::make(instances));
  HitLists own, other;
  ASSERT_TRUE(cube.scene.all(rays, own).ok());
  ASSERT_TRUE(placed.all(rays, other).ok());
  EXPECT_EQ(own.first, other.first);
  std::size_t seams = 0;
  for (std::size_t k = 0; k < rays.size(); ++k) {
    const Hit alone = cube.scene.closest(rays[k]), there = placed.closest(rays[k]);
    ASSERT_EQ(hits[k].kind, alone.kind) << k;
    EXPECT_EQ(outputs.kind[k], alone.kind) << k;
    EXPECT_EQ(dark[k] != 0, alone.kind == HitKind::hit) << k;
    ASSERT_EQ(there.kind, alone.kind) << k;
    if (alone.kind != HitKind::hit) continue;
    EXPECT_EQ(hits[k].t, alone.t) << k;
    EXPECT_EQ(hits[k].patch, alone.patch) << k;
    EXPECT_EQ(hits[k].flags.edge, alone.flags.edge) << k;
    EXPECT_EQ(outputs.flags[k].edge, alone.flags.edge) << k;
    EXPECT_EQ(there.flags.edge, alone.flags.edge) << k;
    EXPECT_NEAR(there.t, alone.t, 1e-9) << k;
    seams += alone.flags.edge;
  }
  EXPECT_GT(seams, 500u);
  for (std::size_t n = 0; n < std::min(own.hits.size(), other.hits.size()); ++n) {
    EXPECT_EQ(own.hits[n].flags.edge, other.hits[n].flags.edge);
    EXPECT_NEAR(own.hits[n].residual, other.hits[n].residual, 1e-9);
    EXPECT_LE(own.hits[n].residual, 2.5 * widest(cube.scene) + 1e-9);
  }
}

TEST(EdgeTubes, FiltersDecideAboutEdgesToo) {
  const Frayed cube;
  const std::vector<Ray> rays = cube.at_edges(2000, 3);
  const std::vector<Hit> hits = closest(cube.scene, rays);
  const Arrays<double> arrays(rays);
  std::vector<std::uint8_t> dark(rays.size(), 7);
  const BatchOptions reject{.filter = [](const HitCandidate&) { return HitVerdict::reject; }};
  ASSERT_TRUE(occluded(cube.scene, arrays.views(), View1<std::uint8_t>::soa({dark}), reject).ok());
  EXPECT_EQ(dark, std::vector<std::uint8_t>(rays.size(), 0));
  Outputs<double> outputs(rays.size());
  const BatchOptions accept{.filter = [](const HitCandidate&) { return HitVerdict::accept; }};
  ASSERT_TRUE(closest(cube.scene, arrays.views(), outputs.views(), accept).ok());
  for (std::size_t k = 0; k < rays.size(); ++k) {
    EXPECT_EQ(outputs.kind[k], hits[k].kind) << k;
    if (hits[k].kind == HitKind::hit) {
      EXPECT_EQ(outputs.flags[k].edge, hits[k].flags.edge) << k;
    }
  }
}

// Rays along an edge, within its gap, meet it; those beside it, parallel, do not.
TEST(EdgeTubes, RaysAlongAnEdge) {
  const Shape shape = gaping_plate(1e-3);
  const PatchSet set = value_of(make_patch_set(shape));
  const RayScene scene = value_of(RayScene::make(set));
  const std::vector<double> gaps = value_of(scene.edge_gaps());
  const Hit along = scene.closest(ray({-1, 0, 1}, {1, 0, 0}));
  ASSERT_EQ(along.kind, HitKind::hit);
  // It begins at a corner, where the border of the end's face may be met as near.
  EXPECT_TRUE(along.flags.edge || along.flags.uncertified) << along.t << ' ' << along.patch;
  EXPECT_GE(along.t, 1 - 1e-9);
  EXPECT_LE(along.t, 5 + 1e-9);
  EXPECT_EQ(scene.closest(ray({-1, -1e-9, 1 + 1e-9}, {1, 0, 0})).kind, HitKind::miss);
  const Hit inside = scene.closest(ray({-1, 1e-9, 1 - 1e-9}, {1, 0, 0}));
  ASSERT_EQ(inside.kind, HitKind::hit);
  EXPECT_FALSE(inside.flags.edge);
  EXPECT_NEAR(inside.t, 1, 1e-9);
  // An infinitely thin ray within the gap between a face and the wall of the hole, straight down.
  const Ray slit = ray({1.7 + 0.5995, 1.4, 5}, {0, 0, -1});
  EXPECT_TRUE(scene.closest(slit).flags.edge);
  EXPECT_EQ(scene.occluded(slit), HitKind::hit);
}

// A tube that holds the origin does not count, but others do, and faces.
TEST(EdgeTubes, RaysThatStartInATube) {
  const Shape shape = gaping_plate(1e-3);
  const PatchSet set = value_of(make_patch_set(shape));
  const RayScene scene = value_of(RayScene::make(set));
  const Vec3 in_slit{1.7 + 0.5995, 1.4, 1};
  EXPECT_EQ(scene.closest(ray(in_slit, {0.1, 0, 1})).kind, HitKind::miss);
  EXPECT_EQ(scene.occluded(ray(in_slit, {0.1, 0, 1})), HitKind::miss);
  const Hit across = scene.closest(ray(in_slit + Vec3{0, 0, 2e-4}, {-1, 0, 0}));
  ASSERT_EQ(across.kind, HitKind::hit);
  EXPECT_TRUE(across.flags.edge);  // the other side of the hole
  EXPECT_NEAR(across.t, 1.2, 2e-3);
  Ray later = ray(in_slit + Vec3{0, 0, 1}, {0, 0, -1});
  later.tnear = 1;
  EXPECT_NEAR(scene.closest(later).t, 2, 2e-3);  // the slit at the bottom
  later.tnear = 0.5;
  EXPECT_NEAR(scene.closest(later).t, 1, 2e-3);
  later.tnear = 0, later.tfar = 0.5;
  EXPECT_EQ(scene.closest(later).kind, HitKind::miss);
}

// Gaps as wide as faces: nothing is known about them, but nothing leaks.
TEST(EdgeTubes, GapsWiderThanFaces) {
  const Shape shape = FrayedCube({1.5}, 8).shape();
  const PatchSet set = value_of(make_patch_set(shape));
  const RayScene scene = value_of(RayScene::make(set));
  EXPECT_GT(widest(scene), 1.0);
  Random random(4);
  HitLists lists;
  for (int k = 0; k < 2000; ++k) {
    const Vec3 eye = Vec3{0.5, 0.5, 0.5} + 20 * normalized(random_direction(random));
    const Ray at = ray(eye, uniform_vector(random, 0, 1) - eye);
    EXPECT_EQ(scene.occluded(at), HitKind::hit);
    ASSERT_TRUE(scene.all({&at, 1}, lists).ok());
    for (const Hit& hit : lists.hits) EXPECT_TRUE(hit.flags.edge);
  }
}

TEST(EdgeTubes, FollowEdits) {
  Frayed cube;
  RayScene scene = value_of(RayScene::make(cube.set, RaySceneOptions{.editable = true}));
  const std::vector<double> before = value_of(scene.edge_gaps());
  std::vector<Vec3> points(cube.set.patch(0).points().begin(), cube.set.patch(0).points().end());
  for (Vec3& p : points) p.x -= 0.01;
  ASSERT_TRUE(cube.set.set_control_points(0, points).ok());
  EXPECT_EQ(scene.edge_gaps().status().code(), StatusCode::stale);
  ASSERT_TRUE(scene.refit().ok());
  const RayScene anew = value_of(RayScene::make(cube.set));
  const std::vector<double> after = value_of(scene.edge_gaps()), made = value_of(anew.edge_gaps());
  ASSERT_EQ(after.size(), made.size());
  for (std::size_t k = 0; k < after.size(); ++k) EXPECT_NEAR(after[k], made[k], 1e-12) << k;
  EXPECT_NE(before, after);
  SolidRays solid(cube.shape, scene, 5);
  solid.cast(5000);
  EXPECT_EQ(solid.tally().leaks, 0u);
  EXPECT_EQ(solid.tally().odd, 0u);
}

// A border that two patches share needs a tube once one of them is edited.
TEST(EdgeTubes, AppearWhereBordersPart) {
  const Shape shape = joined(cube(), 1e-6);
  PatchSet set = value_of(make_patch_set(shape));
  RayScene scene = value_of(RayScene::make(set, RaySceneOptions{.editable = true}));
  std::vector<Vec3> points(set.patch(0).points().begin(), set.patch(0).points().end());
  for (Vec3& p : points) p.z += 1e-3;  // inwards, so that the scene keeps its frame
  ASSERT_TRUE(set.set_control_points(0, points).ok());
  ASSERT_TRUE(scene.refit().ok());
  const std::vector<double> gaps = value_of(scene.edge_gaps());
  EXPECT_EQ(std::ranges::count_if(gaps, [](double gap) { return gap > 1e-3; }), 4);
  const Hit hit = scene.closest(ray({0.5, -5e-4, -1}, {0, 0, 1}));
  EXPECT_EQ(hit.kind, HitKind::hit);
  EXPECT_TRUE(hit.flags.edge);
}

// Patches that move together need none, and nothing is measured where there are no tubes.
TEST(EdgeTubes, BordersThatMoveTogetherNeedNone) {
  const Shape shape = joined(cube(), 1e-6);
  PatchSet set = value_of(make_patch_set(shape));
  RayScene scene = value_of(RayScene::make(set, RaySceneOptions{.editable = true}));
  for (std::size_t patch = 0; patch < set.patch_count(); ++patch) {
    std::vector<Vec3> points(set.patch(patch).points().begin(), set.patch(patch).points().end());
    for (Vec3& p : points) p = 0.9 * p;
    ASSERT_TRUE(set.set_control_points(patch, points).ok());
  }
  ASSERT_TRUE(scene.refit().ok());
  for (const double gap : value_of(scene.edge_gaps())) EXPECT_EQ(gap, 0);
  EXPECT_EQ(scene.closest(ray({0.9 + 1e-6, 0.5, -1}, {0, 0, 1})).kind, HitKind::miss);
  EXPECT_NEAR(scene.closest(ray({0.45, 0.45, -1}, {0, 0, 1})).t, 1, 1e-12);
}

}}  // namespace tessera::test
