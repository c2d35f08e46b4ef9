// Models cut into parts, which trace all rays each: the merged hits are those of the whole model.

#include <gtest/gtest.h>

#include <bit>
#include <cstring>
#include <limits>

#include "ray/ray_support.h"
#include "support/errors.h"
#include "support/seam_rays.h"
#include "support/torus.h"
#include "tessera/part_hits.h"

namespace tessera::test { namespace {

/// Rays at surfaces, at borders and corners, and beside them.
std::vector<Ray> rays_at(const std::vector<BezierPatch>& patches, double size, std::size_t count) {
  Random random(31);
  std::vector<Ray> rays;
  for (std::size_t k = 0; k < count; ++k) {
    if (k % 3 == 0) rays.push_back(rays::at_surface(patches, random, size));
    if (k % 3 == 1) rays.push_back(rays::at_seam(patches, random, size));
    if (k % 3 == 2)
      rays.push_back(through(beside_seam(patches, random, rays::power(random, 1e-15, 1e-3)), random, size));
  }
  return rays;
}

/// The merged hits of all rays, gathered in their order.
Result<std::vector<Hit>> hits_in_parts(const std::vector<BezierPatch>& patches, const std::vector<Ray>& rays,
                                       std::size_t count) {
  const Box3 box = set_of(patches).box();
  std::vector<std::vector<Hit>> runs(count);
  const Status status = run_parts(count, [&](Transport& transport) -> Status {
    const PartRun run = run_of_part(patches.size(), transport.part(), count);
    const PatchSet own = value_of(PatchSet::make(std::span(patches).subspan(run.begin, run.end - run.begin)));
    RaySceneOptions options;
    options.box = box;
    const RayScene scene = value_of(RayScene::make(own, options));
    Result<std::vector<Hit>> merged = closest_in_parts(transport, scene, run.begin, rays);
    if (merged) runs[transport.part()] = *std::move(merged);
    return merged.status();
  });
  if (!status.ok()) return status;
  std::vector<Hit> all;
  for (const std::vector<Hit>& run : runs) all.insert(all.end(), run.begin(), run.end());
  return all;
}

/// Whether two hits are equal to the last bit, but for the work and for doubts.
bool is_same(Hit a, Hit b) {
  if (a.kind != HitKind::hit || b.kind != HitKind::hit) return a.kind == b.kind;
  for (Hit* const hit : {&a, &b}) {
    hit->steps = 0;
    hit->flags = {};
    hit->surface = 0;  // of the parts' sets, which have no sources
  }
  return std::memcmp(&a, &b, sizeof(Hit)) == 0;
}

TEST(PartHits, AreThoseOfTheWhole) {
  std::size_t hits = 0, doubts = 0, missing_doubts = 0;
  for (const std::vector<BezierPatch>& patches :
       {Torus(8).patches(false), Torus(7).patches(true), sphere(), closed_body()}) {
    const PatchSet set = set_of(patches);
    const RayScene scene = value_of(RayScene::make(set));
    const std::vector<Ray> rays = rays_at(patches, set.box().diagonal(), 10'000);
    const std::vector<Hit> expected = closest(scene, rays);
    for (const std::size_t count : {1u, 2u, 4u, 7u}) {
      const Result<std::vector<Hit>> merged = hits_in_parts(patches, rays, std::min(count, patches.size()));
      ASSERT_TRUE(merged.ok()) << merged.status().message();
      ASSERT_EQ(merged->size(), rays.size());
      for (std::size_t k = 0; k < rays.size(); ++k) {
        EXPECT_TRUE(is_same((*merged)[k], expected[k]))
            << count << " parts, ray " << k << ": t " << (*merged)[k].t << " in patch " << (*merged)[k].patch
            << ", expected " << expected[k].t << " in patch " << expected[k].patch;
        if (expected[k].kind != HitKind::hit) continue;
        ++hits;
        EXPECT_LE((*merged)[k].flags.uncertified, expected[k].flags.uncertified) << k;
        doubts += expected[k].flags.uncertified;
        missing_doubts += expected[k].flags.uncertified && !(*merged)[k].flags.uncertified;
      }
    }
  }
  EXPECT_GT(hits, 80'000u);
  EXPECT_LE(missing_doubts, doubts / 2);
  RecordProperty("doubts", std::to_string(doubts));
  RecordProperty("missing_doubts", std::to_string(missing_doubts));
}

/// A hit at a distance in a patch.
Hit hit_at(double t, std::uint32_t patch, std::uint32_t surface) {
  Hit hit;
  hit.kind = HitKind::hit;
  hit.t = t;
  hit.patch = patch;
  hit.surface = surface;
  return hit;
}

TEST(PartHits, NearestWinsAndThenTheLowestPatch) {
  constexpr std::size_t rays = 5, parts = 3;
  std::vector<Hit> merged;
  const Status status = run_parts(parts, [&](Transport& transport) {
    const auto part = static_cast<std::uint32_t>(transport.part());
    std::vector<Hit> hits(rays);
    hits[0] = hit_at(3 - part, 5, part);  // the last part is nearest
    hits[1] = hit_at(1, 4, part);         // equal: the first part wins
    if (part == 1) hits[2] = hit_at(std::numeric_limits<double>::max(), 0, part);
    if (part == 2) hits[3].flags.incomplete = true;
    hits[4].kind = HitKind::invalid_ray;
    const auto own = merge_closest(transport, hits, 100 * part);
    if (!own) return own.status();
    merged.insert(merged.end(), own->begin(), own->end());
    return Status();
  });
  ASSERT_TRUE(status.ok()) << status.message();
  ASSERT_EQ(merged.size(), rays);
  EXPECT_EQ(merged[0].t, 1);
  EXPECT_EQ(merged[0].patch, 205u);
  EXPECT_EQ(merged[0].surface, 2u);
  EXPECT_EQ(merged[1].patch, 4u);
  EXPECT_EQ(merged[1].surface, 0u);
  EXPECT_EQ(merged[2].patch, 100u);
  EXPECT_EQ(merged[3].kind, HitKind::miss);
  EXPECT_TRUE(merged[3].flags.incomplete);
  EXPECT_EQ(merged[4].kind, HitKind::invalid_ray);
}

TEST(PartHits, RunsCoverTheList) {
  for (const std::size_t count : {0u, 1u, 6u, 7u, 100u}) {
    std::size_t end = 0;
    for (std::size_t part = 0; part < 7; ++part) {
      const PartRun run = run_of_part(count, part, 7);
      EXPECT_EQ(run.begin, end);
      EXPECT_LE(run.end - run.begin, count / 7 + 1);
      end = run.end;
    }
    EXPECT_EQ(end, count);
  }
}

TEST(PartHits, WhatCannotBeMergedIsNamed) {
  const auto status_of = [](auto make_hits, std::uint64_t first) {
    return run_parts(2, [&](Transport& transport) {
      const std::vector<Hit> hits = make_hits(transport.part());
      return merge_closest(transport, hits, transport.part() == 1 ? first : 0).status();
    });
  };
  Status status = status_of([](std::size_t part) { return std::vector<Hit>(part + 1); }, 0);
  EXPECT_EQ(status.code(), StatusCode::count_mismatch);
  EXPECT_NE(status.message().find("parts have from 1 to 2 rays"), std::string::npos) << status.message();
  const auto one = [](std::size_t) { return std::vector<Hit>{hit_at(1, 3, 0)}; };
  status = status_of(one, std::uint64_t{1} << 32);
  EXPECT_EQ(status.code(), StatusCode::unsupported);
  EXPECT_EQ(status.message(), "part 1: a hit is in patch 4294967296 + 3 of the model, 2^32 or more");
  EXPECT_TRUE(status_of(one, (std::uint64_t{1} << 32) - 4).ok());
  status = status_of(
      [&](std::size_t) {
        std::vector<Hit> hits{hit_at(1, 3, 0)};
        hits[0].instance = 2;
        return hits;
      },
      0);
  EXPECT_EQ(status.code(), StatusCode::unsupported);
}

TEST(PartHits, StaleSceneOfOnePartIsAnErrorOfAll) {
  const std::vector<BezierPatch> patches = sphere();
  const std::vector<Ray> rays = rays_at(patches, 2, 10);
  const Status status = run_parts(2, [&](Transport& transport) {
    PatchSet set = set_of(patches);
    const RayScene scene = value_of(RayScene::make(set));
    if (transport.part() == 1) {
      const std::vector<Vec3> points(set.patch(0).points().begin(), set.patch(0).points().end());
      EXPECT_TRUE(set.set_control_points(0, points).ok());
    }
    const auto hits = closest_in_parts(transport, scene, 0, rays);
    EXPECT_EQ(hits.status().code(), StatusCode::stale);
    return hits.status();
  });
  EXPECT_TRUE(status.message().starts_with("part 1: ")) << status.message();
}

}}  // namespace tessera::test
