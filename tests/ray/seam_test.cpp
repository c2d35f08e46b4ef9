// Rays beside seams, creases, corners and poles: each root is hit once, and rays that leave a surface there don't hit
// it again. A longer run: tessera_proof_report.

#include "support/seam_rays.h"

#include "ray_support.h"
#include "support/torus.h"
#include "tessera/convert.h"
#include "tessera/nurbs_surface.h"

namespace tessera::test { namespace {

PatchSet unit_sphere() { return set_of(value_of(to_bezier(value_of(make_nurbs_sphere({}, 1)))).take_patches()); }

/// The second root is 3e-11 from a seam; the neighbour sees it too, from beyond the seam.
TEST(Seams, ARootBesideAnotherIsKept) {
  const PatchSet set = unit_sphere();
  const RayScene scene = value_of(RayScene::make(set));
  const std::vector<Hit> hits = all_hits(scene, ray({-4.4575726362827979, 1.2373163892496524, -1.5426150545171542},
                                                    {3.9938552223216548, -2.1232995493543974, 1.5426150545618755}));
  ASSERT_EQ(hits.size(), 2u);
  EXPECT_NEAR(hits[0].t, 0.99744406465212632, 1e-14);
  EXPECT_NEAR(hits[1].t, 0.99999999999999467, 1e-14);
}

TEST(Seams, ARayLeavesItsOriginsNeighbour) {
  const PatchSet set = unit_sphere();
  const RayScene scene = value_of(RayScene::make(set));
  Ray out = ray({-2.1722425132477981e-11, -0.15360072843644251, 0.98813299521056097},
                {0.98158737295893206, -0.19073702938280143, -0.010276909545513786});
  EXPECT_EQ(scene.closest(out).kind, HitKind::hit);
  out.spawn_offset = scene.spawn_offset();
  EXPECT_EQ(scene.closest(out).kind, HitKind::miss);
  EXPECT_EQ(scene.occluded(out), HitKind::miss);
  EXPECT_TRUE(all_hits(scene, out).empty());
}

/// Weights that differ by 2,000 squeeze a fold between two roots into a millionth of the patch.
TEST(Seams, HeavyWeightsHideNoRoot) {
  const std::vector<Vec3> points{{0.3785646298039577, 0.5500537917573115, 0.069331872560898},
                                 {-0.5730638458902692, 0.3187345737275254, -0.534050575598702},
                                 {0.4188866587350718, -0.32207982481377234, -0.01566062289389744},
                                 {-0.3551115086942678, -0.36042828649229974, 0.3662222127671408}};
  const std::vector<double> weights{0.028706489365666714, 23.61814946701269, 105.08855135506073, 0.04323221762999127};
  const PatchSet set = set_of({value_of(BezierPatch::rational(1, 1, points, weights))});
  const RayScene scene = value_of(RayScene::make(set));
  const Ray through = ray({-0.3018660840491213, 0.26669271151915575, -0.13477067689708513},
                          {0.7207527427758896, -0.5887725363333394, 0.11911005400728455});
  const std::vector<Hit> hits = all_hits(scene, through);
  ASSERT_EQ(hits.size(), 2u);
  for (const Hit& hit : hits) {
    EXPECT_FALSE(hit.flags.uncertified);
    EXPECT_GT(std::abs(dot(hit.normal, normalized(through.direction))), 0.1);
  }
  EXPECT_EQ(scene.closest(through).t, hits[0].t);
}

/// The sides of the unit cube.
std::vector<BezierPatch> cube_sides() {
  std::vector<BezierPatch> sides;
  for (const double end : {0.0, 1.0}) {
    std::array<std::vector<Vec3>, 3> points;
    for (const double i : {0.0, 1.0}) {
      for (const double j : {0.0, 1.0})
        points[0].push_back({end, i, j}), points[1].push_back({i, end, j}), points[2].push_back({i, j, end});
    }
    for (const std::vector<Vec3>& side : points) sides.push_back(value_of(BezierPatch::polynomial(1, 1, side)));
  }
  return sides;
}

struct Body {
  const char* name;
  std::vector<BezierPatch> patches;
  bool smooth;
};
std::vector<Body> bodies() {
  return {{"sphere", sphere(), true},
          {"torus", Torus(6).patches(false), true},
          {"torus with creases", Torus(5).patches(true), false},
          {"body with creases", closed_body(), false}};
}

TEST(Seams, EachRootIsCountedOnce) {
  for (const Body& body : bodies()) {
    const PatchSet set = set_of(body.patches);
    const double size = set.box().diagonal();
    const RayScene scene = value_of(RayScene::make(set));
    Random random(81);
    SeamTally tally;
    for (int power = 6; power <= 15; ++power) {
      for (int k = 0; k < 300; ++k)
        check_count(scene, through(beside_seam(body.patches, random, std::pow(10.0, -power)), random, size), size,
                    body.smooth, tally);
    }
    EXPECT_GT(tally.decided, tally.rays / 2) << body.name;
    EXPECT_EQ(tally.wrong, 0u) << body.name;
    EXPECT_LE(tally.flagged, tally.rays / 500) << body.name;
    EXPECT_EQ(tally.not_first, 0u) << body.name;
    EXPECT_LE(tally.pairs, tally.rays / 500) << body.name;
  }
}

/// A line touches a crease or a corner, or passes through it, within rounding. By chance, it meets one of the patches
/// that fold over each other there and misses the other.
TEST(Seams, ClosedBodiesAreCrossedAnEvenNumberOfTimes) {
  std::size_t odd = 0, pairs = 0;
  for (const std::vector<BezierPatch>& patches : {cube_sides(), closed_body(), Torus(5).patches(true)}) {
    const PatchSet set = set_of(patches);
    const double size = set.box().diagonal();
    const RayScene scene = value_of(RayScene::make(set));
    Random random(85);
    for (int k = 0; k < 40000; ++k) {
      const Vec3 target = beside_seam(patches, random, 0).position +
                          rays::power(random, 1e-16, 1e-12) * size * rays::unit_vector(random);
      const Vec3 from = set.box().centre() + size * rays::unit_vector(random);
      const std::vector<Hit> hits = all_hits(scene, rays::from_to(from, target - from));
      const bool is_sure = std::ranges::none_of(hits, [](const Hit& hit) { return hit.flags.uncertified; });
      odd += is_sure && hits.size() % 2 == 1;
      pairs += !is_sure && hits.size() % 2 == 0;
    }
  }
  EXPECT_EQ(odd, 0u);
  EXPECT_GT(pairs, 0u);  // without the rule, each of these is one hit
}

/// On smooth bodies no ray hits the surface again within a millionth.
TEST(Seams, NothingIsMetByLeavingIt) {
  for (const Body& body : bodies()) {
    if (!body.smooth) continue;
    const PatchSet set = set_of(body.patches);
    const RayScene scene = value_of(RayScene::make(set));
    Random random(82);
    std::size_t again = 0, occluded = 0;
    for (int power = 6; power <= 15; ++power) {
      for (int k = 0; k < 1000; ++k) {
        Ray out = leaving(scene, beside_seam(body.patches, random, std::pow(10.0, -power)), random);
        out.tfar = 1e-6;
        again += scene.closest(out).kind == HitKind::hit;
        occluded += scene.occluded(out) == HitKind::hit;
      }
    }
    EXPECT_EQ(again, 0u) << body.name;
    EXPECT_EQ(occluded, 0u) << body.name;
  }
}

/// A hit beyond a crease is truly there: the ray passes through the hit's patch, to the last digits.
TEST(Seams, BeyondACreaseIsMetWhatIsThere) {
  for (const Body& body : bodies()) {
    if (body.smooth) continue;
    const PatchSet set = set_of(body.patches);
    const RayScene scene = value_of(RayScene::make(set));
    Random random(83);
    std::size_t met = 0;
    for (int power = 7; power <= 15; ++power) {
      for (int k = 0; k < 500; ++k) {
        Ray out = leaving(scene, beside_seam(body.patches, random, std::pow(10.0, -power)), random);
        out.tfar = 1e-6;
        const Hit hit = scene.closest(out);
        if (hit.kind != HitKind::hit) continue;
        ++met;
        EXPECT_FALSE(hit.flags.uncertified) << body.name;
        EXPECT_LT(hit.residual, 1e-14) << body.name;
      }
    }
    EXPECT_GT(met, 20u) << body.name;
  }
}

/// Places where roots are known by construction, near borders, under weights of 1e-3 to 1e3.
TEST(Seams, HeavyWeightsBesideBorders) {
  Random random(84);
  std::vector<BezierPatch> patches;
  for (int k = 0; k < 24; ++k)
    patches.push_back(
        random_rational(random, 1 + k % 3, 1 + k / 2 % 3, 1e-3, 1e3, {2.5 * (k % 6), 2.5 * std::floor(k / 6), 0}));
  const PatchSet set = set_of(patches);
  const double size = set.box().diagonal();
  const RayScene scene = value_of(RayScene::make(set));
  for (int k = 0; k < 8000; ++k) {
    const SeamPlace place = beside_seam(patches, random, rays::power(random, 1e-9, 0.5));
    const Ray at = through(place, random, size);
    const double speed = length(at.direction), t = dot(place.position - at.origin, at.direction) / (speed * speed);
    const std::vector<Hit> hits = all_hits(scene, at);
    EXPECT_TRUE(std::any_of(hits.begin(), hits.end(), [&](const Hit& hit) {
      return std::abs(hit.t - t) * speed < 1e-7;
    })) << k;
    const Hit first = scene.closest(at);
    ASSERT_EQ(first.kind, HitKind::hit) << k;
    EXPECT_LE((first.t - t) * speed, 1e-7) << k;
    for (const Hit& hit : hits) EXPECT_TRUE(hit.flags.uncertified || hit.residual <= 2e-12 * size) << k;
  }
}

}}  // namespace tessera::test
