// Compares exact mode with a reference in interval arithmetic; no ray may leave closed bodies. A longer run:
// tessera_proof_report.

#include <iostream>

#include "ray_support.h"
#include "support/ray_classes.h"
#include "support/ray_proof.h"

namespace tessera::test { namespace {

RayScene proof_exact_scene(const PatchSet& set, int pieces = 2) {
  RaySceneOptions options;
  options.mode = RayMode::exact;
  options.pieces = pieces;
  return value_of(RayScene::make(set, options));
}

TEST(Reference, KnowsAPlane) {
  const std::vector<BezierPatch> plane{polynomial(1, 1, {{0, 0, 1}, {0, 2, 1}, {2, 0, 1}, {2, 2, 1}})};
  const Verdict hit = reference_verdict(plane, ray({0.5, 0.25, -3}, {0, 0, 2}));
  ASSERT_TRUE(hit.hit());
  EXPECT_TRUE(hit.first().t.holds(2));
  EXPECT_TRUE(hit.first().u.holds(0.25) && hit.first().v.holds(0.125));
  EXPECT_LT(hit.first().t.width(), 1e-12);
  EXPECT_TRUE(reference_verdict(plane, ray({0.5, 2.25, -3}, {0, 0, 2})).miss());
  EXPECT_TRUE(reference_verdict(plane, ray({0.5, 0.25, 3}, {0, 0, 2})).miss());
  EXPECT_FALSE(reference_verdict(plane, ray({0.5, 2, -3}, {0, 0, 2})).hit());  // at the border nothing is proven inside
  EXPECT_FALSE(reference_verdict(plane, ray({0.5, 2, -3}, {0, 0, 2})).miss());  // nor excluded
}

TEST(ExactMode, MissesNothingThatIsProven) {
  constexpr int rays_per_class = 25;
  std::size_t hits = 0, undecidable = 0;
  for (const RayClass& rays : ray_classes()) {
    SCOPED_TRACE(rays.name);
    const PatchSet set = set_of(rays.patches);
    const double size = set.box().diagonal();
    const RayScene scene = proof_exact_scene(set);
    Random random(31);
    ProofTally tally;
    for (int k = 0; k < rays_per_class; ++k)
      check_ray(rays.patches, scene, rays.draw(random), 5e-12 * size, size, tally);
    EXPECT_EQ(tally.missed, 0u);
    EXPECT_EQ(tally.false_hits, 0u);
    EXPECT_EQ(tally.incomplete, 0u);
    EXPECT_EQ(tally.contradicted, 0u);
    hits += tally.hits, undecidable += tally.undecidable;
  }
  std::cout << hits << " proven hits, " << undecidable << " undecidable rays\n";
  EXPECT_GT(hits, 250u);
  EXPECT_LT(undecidable, hits / 3);
}

/// At seams of a torus, almost along it: the ray enters 1e-6 before the seam, over which the surface rises by 1e-13,
/// and hits the neighbour on the seam itself, a root by all proofs.
TEST(ExactMode, NoProvenRootHidesWhatBeginsBeforeIt) {
  const std::vector<BezierPatch> torus = Torus(5).patches(true);
  const PatchSet set = value_of(PatchSet::make(torus));
  RaySceneOptions options;
  options.mode = RayMode::exact;
  const RayScene scene = value_of(RayScene::make(set, options));
  const double size = set.box().diagonal();
  const Vec3 lines[][2] = {{{0x1.95234064da1a3p+1, 0x1.b743c9beb5a32p+0, 0x1.6fa3add5d7cf1p+1},
                            {-0x1.662ed2e8ccea4p-1, -0x1.9719c1965496ep-2, -0x1.30001e1c715c8p-1}},
                           {{-0x1.8286bebdd613dp+0, -0x1.bcfa45b6b3eb8p+0, 0x1.5c6414f206d63p-2},
                            {0x1.223f3d51ef3f5p-1, 0x1.a59f8e3c42e1cp-1, -0x1.7318bee937161p-6}},
                           {{0x1.ffa9bdea4471ep-2, 0x1.d70282aea2524p+0, -0x1.7fd1b755666d7p+1},
                            {-0x1.e9bbe84352526p-5, -0x1.1c0ec17601e5bp-2, 0x1.eaf3fe0c2b86bp-1}}};
  for (const auto& line : lines) {
    const Ray ray = rays::from_to(line[0], line[1]);
    ProofTally tally;
    check_ray(torus, scene, ray, 5e-12 * size, size, tally);
    EXPECT_EQ(tally.hits, 1u);
    EXPECT_EQ(tally.missed, 0u);
    EXPECT_EQ(tally.false_hits, 0u);
    HitLists lists;
    ASSERT_TRUE(scene.all(std::span(&ray, 1), lists).ok());
    ASSERT_FALSE(lists.hits.empty());
    EXPECT_TRUE(lists.hits.front().flags.uncertified);
  }
}

TEST(ExactMode, NothingLeavesAClosedBody) {
  for (const auto& patches : {closed_body(), sphere(), placed(closed_body(), 1e-5, {3e-2, 0, 7e-2})}) {
    const PatchSet set = set_of(patches);
    const Vec3 centre = set.box().centre();
    const double scale = set.box().diagonal() / set_of(closed_body()).box().diagonal();
    const bool about_zero = length(centre) < scale;
    for (const int pieces : {1, 2, 4}) {
      const RayScene scene = proof_exact_scene(set, pieces);
      Random random(32);
      std::size_t leaks = 0, at_seams = 0;
      for (int k = 0; k < 4000; ++k) {
        auto [inside, one] = about_zero ? chord_of_seam(patches, random) : std::pair(false, Ray{});
        if (!inside) one = ray(centre + 0.2 * scale * random_direction(random), random_direction(random));
        at_seams += inside;
        leaks += scene.closest(one).kind != HitKind::hit || scene.occluded(one) != HitKind::hit;
      }
      EXPECT_EQ(leaks, 0u);
      EXPECT_TRUE(!about_zero || at_seams > 1000);
    }
  }
}

/// Next to a seam both neighbours see the ray in coordinates of their own: neither may round it to the other's side.
TEST(ExactMode, NothingLeavesAlongSeams) {
  for (const auto& [side, rational] : {std::pair<std::size_t, bool>{40, false}, {9, false}, {12, true}}) {
    const std::vector<BezierPatch> torus = Torus(side).patches(rational);
    const PatchSet set = set_of(torus);
    for (const Isa isa : available_isas()) {
      RaySceneOptions options;
      options.isa = isa;
      const RayScene scene = value_of(RayScene::make(set, options));
      Random random(34);
      std::vector<Ray> rays;
      for (int k = 0; k < 20000; ++k) rays.push_back(skimming_seam(torus, random));
      std::vector<std::uint8_t> occluded(rays.size());
      ASSERT_TRUE(scene.occluded(rays, occluded).ok());
      const std::vector<Hit> hits = closest(scene, rays);
      std::size_t leaks = 0;
      for (std::size_t k = 0; k < rays.size(); ++k) leaks += hits[k].kind != HitKind::hit || occluded[k] == 0;
      EXPECT_EQ(leaks, 0u) << side << ' ' << rational << ' ' << name(isa);
    }
  }
}

TEST(ExactMode, LinesCrossClosedBodiesEvenly) {
  // A tangential point counts once, so rays that touch are left out. So is a point of a crease that the ray passes
  // outside of: therefore rays aim at places where patches meet only on the smooth body.
  for (const auto& [patches, smooth] : {std::pair{closed_body(), false}, {sphere(), true}}) {
    const PatchSet set = set_of(patches);
    const RayScene scene = proof_exact_scene(set);
    Random random(33);
    std::vector<Ray> lines;
    for (int k = 0; k < 4000; ++k) {
      lines.push_back(k % 2 == 0 && smooth ? rays::at_seam(patches, random, 10)
                                           : rays::at_surface(patches, random, 30));
      lines.back().origin += -10.0 * normalized(lines.back().direction);
    }
    HitLists lists;
    ASSERT_TRUE(scene.all(lines, lists).ok());
    ASSERT_EQ(lists.first.size(), lines.size() + 1);
    std::size_t odd = 0, counted = 0;
    for (std::size_t k = 0; k < lines.size(); ++k) {
      bool touches = false;
      for (std::size_t h = lists.first[k]; h < lists.first[k + 1]; ++h) {
        const Hit& hit = lists.hits[h];
        touches |= hit.flags.uncertified || std::abs(dot(normalized(lines[k].direction), hit.normal)) < 1e-4;
        EXPECT_TRUE(h == lists.first[k] || hit.t >= lists.hits[h - 1].t);
      }
      if (touches) continue;
      ++counted;
      odd += (lists.first[k + 1] - lists.first[k]) % 2;
    }
    EXPECT_EQ(odd, 0u);
    EXPECT_GT(counted, 2000u);
  }
}

}}  // namespace tessera::test
