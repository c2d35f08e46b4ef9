// Exact rays see the parts of faces that loops keep, and nothing else.

#include <atomic>
#include <cmath>
#include <numbers>
#include <vector>

#include "join/unjoined_faces.h"
#include "ray/batch_support.h"
#include "tess_trim/closed_shape.h"
#include "tess_trim/trimmed_face.h"
#include "tessera/edge_matching.h"
#include "tessera/trim_region.h"
#include "trim/trim_piece.h"

namespace tessera::test { namespace {

/// The hits of all kinds of queries of a scene, beside those that a referee keeps of the whole surface's.
void expect_kept(const Face& face, const RaySceneOptions& options, const std::vector<Ray>& rays) {
  const PatchSet whole_set = value_of(make_patch_set(face.model, {.trims = false}));
  const RayScene whole = value_of(RayScene::make(whole_set)), scene = value_of(RayScene::make(face.set, options));
  const TrimRegion region = value_of(TrimRegion::make(*face.model.surfaces[0].trims, face.grid));
  HitLists all_of_whole, lists;
  ASSERT_TRUE(whole.all(rays, all_of_whole).ok());
  ASSERT_TRUE(scene.all(rays, lists).ok());
  const std::vector<Hit> hits = closest(scene, rays);
  std::vector<std::uint8_t> occluded(rays.size());
  ASSERT_TRUE(scene.occluded(rays, occluded).ok());
  std::size_t kept = 0, cut_away = 0;
  for (std::size_t k = 0; k < rays.size(); ++k) {
    std::vector<Hit> expected;
    for (std::size_t n = all_of_whole.first[k]; n < all_of_whole.first[k + 1]; ++n) {
      const Hit& hit = all_of_whole.hits[n];
      const bool is_kept = region.locate(hit.u, hit.v) != TrimSide::outside;
      if (is_kept) expected.push_back(hit);
      ++(is_kept ? kept : cut_away);
    }
    ASSERT_EQ(lists.first[k + 1] - lists.first[k], expected.size()) << k;
    for (std::size_t n = 0; n < expected.size(); ++n) {
      const Hit& found = lists.hits[lists.first[k] + n];
      EXPECT_NEAR(found.t, expected[n].t, 1e-9) << k;
      EXPECT_NEAR(found.u, expected[n].u, 1e-6) << k;
    }
    EXPECT_EQ(occluded[k], expected.empty() ? 0 : 1) << k;
    EXPECT_EQ(hits[k].kind, expected.empty() ? HitKind::miss : HitKind::hit) << k;
    const Hit alone = scene.closest(rays[k]);
    EXPECT_EQ(alone.kind, hits[k].kind) << k;
    EXPECT_EQ(scene.occluded(rays[k]) == HitKind::hit, occluded[k] != 0) << k;
    if (expected.empty()) continue;
    EXPECT_NEAR(hits[k].t, expected[0].t, 1e-9) << k;
    EXPECT_EQ(alone.t, hits[k].t) << k;
  }
  EXPECT_GT(kept, rays.size() / 100);
  EXPECT_GT(cut_away, rays.size() / 100);
}

/// For rays aimed at the whole surface's box, or at a part of it.
void expect_kept(const Face& face, const RaySceneOptions& options, std::uint64_t seed, const Box3& aim = {}) {
  expect_kept(face, options, rays_through(aim.empty() ? face.grid.box() : aim, 4000, seed));
}

std::vector<TrimLoop> outline_with_holes() {
  return {space_polygon({{0.3, 0.2, 0}, {3.7, 0.4, 0}, {3.5, 2.8, 0}, {0.5, 2.6, 0}}),
          circle_loop(1.5, 1.3, 0.7, true, 0.4), circle_loop(2.8, 1.8, 0.45, true)};
}

TEST(TrimmedScene, HoldsWhatLoopsKeep) {
  for (const int pieces : {1, 4}) {
    expect_kept(Face(plane(), outline_with_holes()), {.pieces = pieces}, 1);
    expect_kept(Face(wavy(), outline_with_holes()), {.pieces = pieces}, 2);
    expect_kept(Face(cylinder(), outline_with_holes()), {.pieces = pieces}, 3);
  }
}

/// The box of a surface's points whose parameters a loop of circles or polygons holds in its hull.
Box3 box_of_loops(const Face& face) {
  Box3 box;
  Domain hull{1e9, -1e9, 1e9, -1e9};
  for (const TrimLoop& loop : *face.model.surfaces[0].trims)
    for (const Curve& curve : loop.curves)
      for (const Vec3& p : curve.points())
        hull = {std::min(hull.u0, p.x), std::max(hull.u1, p.x), std::min(hull.v0, p.y), std::max(hull.v1, p.y)};
  for (int i = 0; i <= 50; ++i)
    for (int j = 0; j <= 50; ++j)
      box.extend(
          value_of(evaluate_jet(face.model.surfaces[0].surface, hull.u_at(i / 50.0), hull.v_at(j / 50.0))).position);
  return box;
}

// Leaves shrink to the kept part of a surface, however small, wherever it lies, and no hit is lost by that.
TEST(TrimmedScene, BoxesShrinkToWhatLoopsKeep) {
  const std::vector<std::vector<TrimLoop>> small = {{circle_loop(0.9, 0.8, 0.3, false)},
                                                    {space_polygon({{2.5, 1.9, 0}, {2.9, 2.1, 0}, {2.4, 2.6, 0}})},
                                                    {circle_loop(3.2, 2.3, 0.02, false)},
                                                    {space_polygon({{0.2, 0.8, 0}, {3.1, 2.2, 0}, {0.2, 0.86, 0}})},
                                                    {space_polygon({{0, 0, 0}, {0.3, 0, 0}, {0, 0.2, 0}})}};
  std::uint64_t seed = 20;
  for (const std::vector<TrimLoop>& loops : small) {
    for (const BSplineSurface& surface : {plane(), wavy(), cylinder()}) {
      const Face face(surface, loops);
      const Box3 kept = box_of_loops(face);
      for (const int pieces : {1, 4}) {
        const RayScene scene = value_of(RayScene::make(face.set, RaySceneOptions{.pieces = pieces}));
        EXPECT_LT(scene.box().diagonal(), 1.3 * kept.diagonal());
        EXPECT_LT(length(scene.box().centre() - kept.centre()), 0.3 * kept.diagonal());
        expect_kept(face, {.pieces = pieces}, ++seed, kept);
      }
    }
  }
}

// Where only a corner is cut away, or a hole far from it, all the rest stays.
TEST(TrimmedScene, CornersThatLoopsKeepAreNotCutOff) {
  for (const BSplineSurface& surface : {plane(), wavy(), cylinder()}) {
    for (const TrimLoop& loop : {circle_loop(0.8, 0.6, 0.5, true), circle_loop(3.4, 2.5, 0.45, true)}) {
      const Face face(surface, {loop});
      expect_kept(face, {}, 60);
      expect_kept(face, {.pieces = 4}, 61);
    }
  }
}

// A ray far from what is kept looks at no piece, also after a refit.
TEST(TrimmedScene, RaysBesideTheKeptPartLookAtNothing) {
  Face face(plane(), {circle_loop(3.2, 2.3, 0.02, false)});
  RayScene scene = value_of(RayScene::make(face.set, RaySceneOptions{.editable = true}));
  const auto look = [&](double x, double y, double z) { return scene.closest(ray({x, y, 9}, {0.01, 0, z - 9})); };
  EXPECT_EQ(look(1, 1, 1).steps, 0);
  EXPECT_EQ(look(3.2, 2.3, 1).kind, HitKind::hit);
  std::vector<Vec3> points(face.set.patch(0).points().begin(), face.set.patch(0).points().end());
  for (Vec3& p : points) p = {0.5 * p.x, 0.5 * p.y, p.z + 1};
  ASSERT_TRUE(face.set.set_control_points(0, points).ok());
  ASSERT_TRUE(scene.refit().ok());
  EXPECT_NEAR(length(scene.box().centre() - Vec3{1.6, 1.15, 2}), 0, 0.005);
  EXPECT_LT(scene.box().diagonal(), 0.04);
  EXPECT_EQ(look(1.6, 1.15, 2).kind, HitKind::hit);
  EXPECT_EQ(look(3.2, 2.3, 1).steps, 0);
  EXPECT_EQ(look(0.9, 0.9, 2).steps, 0);
}

// Rays beside loops, 1e-2 to 1e-8 off in the parameters, in coherent packets.
TEST(TrimmedScene, RaysBesideLoopsAreDecidedOneByOne) {
  Random random(33);
  for (const BSplineSurface& surface : {plane(), wavy(), cylinder()}) {
    const Face face(surface, outline_with_holes());
    std::vector<Ray> rays;
    for (std::size_t k = 0; k < 4000; ++k) {
      const TrimLoop& loop = (*face.model.surfaces[0].trims)[k / 16 % 3];
      const Curve& curve = loop.curves[0];
      const tessera::Interval range = curve.domain();
      const double t = range.from + (0.1 + 0.02 * static_cast<double>(k % 16)) * (range.to - range.from);
      const Vec3 at = evaluate_jet(curve, t).position;
      const double off = std::pow(10, -2 - 6 * uniform(random, 0, 1)), angle = 6.3 * uniform(random, 0, 1);
      const Vec3 p = evaluate_jet(surface, at.x + off * std::cos(angle), at.y + off * std::sin(angle)).position;
      const Vec3 eye{1.5 + 0.01 * static_cast<double>(k / 16), 1, 40};
      rays.push_back(ray(eye, p - eye));
    }
    expect_kept(face, {}, rays);
  }
}

TEST(TrimmedScene, AsksFiltersAboutKeptRootsAlone) {
  const Face face(wavy(), outline_with_holes());
  const TrimRegion region = value_of(TrimRegion::make(*face.model.surfaces[0].trims, face.grid));
  const RayScene scene = value_of(RayScene::make(face.set));
  const Arrays<double> rays(rays_through(face.set.box(), 500, 7));
  std::atomic<std::size_t> asked = 0;
  const BatchOptions reject{.filter = [&](const HitCandidate& at) {
    ++asked;
    EXPECT_NE(region.locate(at.u, at.v), TrimSide::outside);
    return HitVerdict::reject;
  }};
  std::vector<std::uint8_t> dark(500, 7);
  ASSERT_TRUE(occluded(scene, rays.views(), View1<std::uint8_t>::soa({dark}), reject).ok());
  EXPECT_EQ(dark, std::vector<std::uint8_t>(500, 0));
  EXPECT_GT(asked, 100u);
}

/// A closed plate with a hole, and far from it a scrap, which keeps other parameters than those of the plate's walls.
Shape plate_and_scrap() {
  std::vector<ModelSurface> faces = drilled_plate();
  const TrimLoop scrap = space_polygon({{3.6, 2.6, 0}, {3.9, 2.6, 0}, {3.9, 2.9, 0}, {3.6, 2.9, 0}});
  faces.insert(faces.begin(), rectangle_face({100, 0, 0}, {4, 0, 0}, {0, 3, 0}, {scrap}));
  return value_of(joined_shape(faces, 1e-6));
}

// A ray through the hole of a closed plate meets nothing; one beside it meets two faces.
TEST(TrimmedScene, RaysPassThroughTheHolesOfAShape) {
  const Shape shape = plate_and_scrap();
  const PatchSet set = value_of(make_patch_set(shape));
  const RayScene scene = value_of(RayScene::make(set));
  std::vector<Ray> rays;
  std::vector<double> off;  // from the wall of the hole
  for (int i = 0; i < 160; ++i)
    for (int j = 0; j < 120; ++j) {  // neighbours in packets
      const double x = 4 * (i + 0.37) / 160, y = 3 * (j + 0.41) / 120;
      rays.push_back(ray({x, y, 5}, {0, 0, -1}));
      off.push_back(std::hypot(x - 1.7, y - 1.4) - 0.6);
    }
  const std::vector<Hit> hits = closest(scene, rays);
  std::vector<std::uint8_t> dark(rays.size());
  HitLists lists;
  ASSERT_TRUE(scene.occluded(rays, dark).ok());
  ASSERT_TRUE(scene.all(rays, lists).ok());
  for (std::size_t k = 0; k < rays.size(); ++k) {
    const bool is_kept = off[k] > 0;
    ASSERT_EQ(hits[k].kind, is_kept ? HitKind::hit : HitKind::miss) << off[k];
    ASSERT_EQ(scene.closest(rays[k]).kind, hits[k].kind) << off[k];
    ASSERT_EQ(dark[k] != 0, is_kept) << off[k];
    ASSERT_EQ(lists.first[k + 1] - lists.first[k], is_kept ? 2u : 0u) << off[k];
    if (is_kept) {
      EXPECT_NEAR(hits[k].t, 4, 1e-12);
    }
  }
}

// Rays at all angles meet a closed body an even number of times, in packets and alone.
TEST(TrimmedScene, RaysMeetAClosedBodyAnEvenNumberOfTimes) {
  const Shape shape = plate_and_scrap();
  const PatchSet set = value_of(make_patch_set(shape));
  const RayScene scene = value_of(RayScene::make(set));
  Random random(9);
  std::size_t met = 0;
  for (int round = 0; round < 300; ++round) {
    const Vec3 centre{2, 1.5, 0.5}, eye = centre + 6 * normalized(random_direction(random));
    const Vec3 at = centre + uniform_vector(random, -1, 1);
    std::vector<Ray> rays;
    for (int k = 0; k < 16; ++k) rays.push_back(ray(eye, at + 0.05 * uniform_vector(random, -1, 1) - eye));
    HitLists lists;
    ASSERT_TRUE(scene.all(rays, lists).ok());
    const std::vector<Hit> hits = closest(scene, rays);
    for (std::size_t k = 0; k < rays.size(); ++k) {
      const std::size_t count = lists.first[k + 1] - lists.first[k];
      EXPECT_EQ(count % 2, 0u);
      ASSERT_EQ(hits[k].kind, count > 0 ? HitKind::hit : HitKind::miss);
      if (count > 0) {
        EXPECT_NEAR(hits[k].t, lists.hits[lists.first[k]].t, 1e-12);
        ++met;
      }
    }
  }
  EXPECT_GT(met, 2000u);
}

TEST(TrimmedScene, HitsAtALoopAreUncertifiedAndBesideItAreNot) {
  const Face face(plane(), {space_polygon({{1, 1, 0}, {3, 1, 0}, {3, 2, 0}, {1, 2, 0}})});
  const RayScene scene = value_of(RayScene::make(face.set));
  // The plane's parameters are x and y.
  const auto at = [&](double x, double y) { return scene.closest(ray({x, y, 4}, {0, 0, -1})); };
  EXPECT_EQ(at(1 - 1e-9, 1.5).kind, HitKind::miss);
  EXPECT_EQ(at(1 + 1e-9, 1.5).kind, HitKind::hit);
  EXPECT_FALSE(at(1 + 1e-9, 1.5).flags.uncertified);
  EXPECT_EQ(at(1, 1.5).kind, HitKind::hit);
  EXPECT_TRUE(at(1, 1.5).flags.uncertified);
  EXPECT_TRUE(at(3, 2).flags.uncertified);
}

// A ray within a plane enters what is kept of it at the loop, not at the border of the whole plane.
TEST(TrimmedScene, RaysAlongAPlaneMeetWhatIsKept) {
  const Face face(plane(), {space_polygon({{1, 1, 0}, {3, 1, 0}, {3, 2, 0}, {1, 2, 0}})});
  const RayScene scene = value_of(RayScene::make(face.set));
  const Hit hit = scene.closest(ray({-1, 1.5, 1}, {1, 0, 0}));
  EXPECT_EQ(hit.kind, HitKind::hit);
  EXPECT_TRUE(hit.flags.uncertified);
  EXPECT_TRUE(hit.flags.tangential);
  EXPECT_GE(hit.t, 2 - 1e-9);
  EXPECT_LE(hit.t, 2.25);
  EXPECT_EQ(scene.closest(ray({-1, 0.5, 1}, {1, 0, 0})).kind, HitKind::miss);
}

/// A loop around most of a 4 x 3 domain, of that many straight pieces.
TrimLoop round_polygon(int corners) {
  std::vector<Vec3> points;
  for (int k = 0; k < corners; ++k) {
    const double angle = 2 * std::numbers::pi * k / corners;
    points.push_back({2 + 1.8 * std::cos(angle), 1.5 + 1.3 * std::sin(angle), 0});
  }
  return space_polygon(points);
}

/// Compares closest hits in grid mode with those in exact mode, and occlusion with closest hits. Only silhouettes
/// differ.
void expect_grid_as_exact(const Face& face, const std::vector<Ray>& rays) {
  const TrimRegion region = value_of(TrimRegion::make(*face.model.surfaces[0].trims, face.grid));
  const RayScene exact = value_of(RayScene::make(face.set));
  const RayScene grid = value_of(RayScene::make(face.set, RaySceneOptions{.mode = RayMode::grid, .rate = 16}));
  const std::vector<Hit> expected = closest(exact, rays), hits = closest(grid, rays);
  std::vector<std::uint8_t> dark(rays.size());
  ASSERT_TRUE(grid.occluded(rays, dark).ok());
  std::size_t met = 0, passed = 0, other = 0;
  for (std::size_t k = 0; k < rays.size(); ++k) {
    const bool is_hit = hits[k].kind == HitKind::hit;
    if (is_hit) {
      EXPECT_NE(region.locate(hits[k].u, hits[k].v), TrimSide::outside) << k;
    }
    const bool is_same = hits[k].kind == expected[k].kind && (!is_hit || std::abs(hits[k].t - expected[k].t) < 1e-6);
    other += !is_same || (dark[k] != 0) != is_hit;
    ++(is_hit ? met : passed);
  }
  EXPECT_LT(other, rays.size() / 200);
  EXPECT_GT(met, rays.size() / 20);
  EXPECT_GT(passed, rays.size() / 20);
}

TEST(TrimmedScene, GridModeHoldsWhatLoopsKeep) {
  for (const BSplineSurface& surface : {plane(), wavy(), cylinder()}) {
    const Face face(surface, outline_with_holes());
    expect_grid_as_exact(face, rays_through(face.grid.box(), 2000, 70));
    std::vector<Ray> rows;  // in packets
    const Vec3 eye = face.grid.box().centre() + Vec3{3, 4, 20};
    for (int k = 0; k < 2500; ++k) {
      const Box3& box = face.grid.box();
      const double x = (k % 50 + 0.5) / 50, y = (k / 50 + 0.5) / 50;
      const Vec3 at{box.lower.x + x * (box.upper.x - box.lower.x), box.lower.y + y * (box.upper.y - box.lower.y),
                    box.centre().z};
      rows.push_back(ray(eye, at - eye));
    }
    expect_grid_as_exact(face, rows);
  }
}

// The cells of a region grow with its pieces: by at least a cell of 4 bytes and an entry of 64 for each.
TEST(TrimmedScene, MemoryHoldsTheCellsOfRegions) {
  const Face few(plane(), {round_polygon(8)}), many(plane(), {round_polygon(4008)});
  const RayScene small = value_of(RayScene::make(few.set)), large = value_of(RayScene::make(many.set));
  EXPECT_GT(large.memory_bytes(), small.memory_bytes() + 4000 * (sizeof(TrimPiece) + 68));
  EXPECT_LT(large.memory_bytes(), small.memory_bytes() + 4000 * 2000);
}

TEST(TrimmedScene, InstancesAndRefitsKeepTheLoops) {
  Face face(plane(), {space_polygon({{1, 1, 0}, {3, 1, 0}, {3, 2, 0}, {1, 2, 0}})});
  RayScene scene = value_of(RayScene::make(face.set, RaySceneOptions{.editable = true}));
  {
    const RayInstance instances[] = {{&scene, Affine::translated({10, 0, 0})}};
    const RayScene placed = value_of(RayScene::make(instances));
    EXPECT_EQ(placed.closest(ray({12, 1.5, 4}, {0, 0, -1})).kind, HitKind::hit);
    EXPECT_EQ(placed.closest(ray({10.5, 1.5, 4}, {0, 0, -1})).kind, HitKind::miss);
  }
  std::vector<Vec3> points(face.set.patch(0).points().begin(), face.set.patch(0).points().end());
  for (Vec3& p : points) p.z += 1;
  ASSERT_TRUE(face.set.set_control_points(0, points).ok());
  ASSERT_TRUE(scene.refit().ok());
  const Hit hit = scene.closest(ray({2, 1.5, 4}, {0, 0, -1}));
  EXPECT_EQ(hit.kind, HitKind::hit);
  EXPECT_NEAR(hit.t, 2, 1e-12);
  EXPECT_EQ(scene.closest(ray({0.5, 1.5, 4}, {0, 0, -1})).kind, HitKind::miss);
}

}}  // namespace tessera::test
