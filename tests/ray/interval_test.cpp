// tnear and tfar hold for the refined t, in double; any hit and closest hit agree.

#include <cmath>

#include "ray/gaping_shapes.h"
#include "ray/lattice_body.h"
#include "support/seam_rays.h"
#include "support/solid_rays.h"

namespace tessera::test { namespace {

class Interval : public testing::Test {
 protected:
  PatchSet set_ = set_of(sphere());
  RayScene scene_ = scene_of(set_, 5);  // coarse: facets lie well inside the sphere
};

TEST_F(Interval, EndsAtTheHitAreInclusive) {
  Random random(21);
  for (int k = 0; k < 500; ++k) {
    const Vec3 target = normalized(random_direction(random));
    Ray one = ray(3 * target + 0.5 * random_direction(random), {});
    one.direction = target - one.origin;
    const Hit first = scene_.closest(one);
    ASSERT_EQ(first.kind, HitKind::hit);
    one.tfar = first.t;
    EXPECT_EQ(scene_.closest(one).kind, HitKind::hit);
    EXPECT_EQ(scene_.closest(one).t, first.t);
    one.tfar = first.t * (1 - 1e-9);
    EXPECT_EQ(scene_.closest(one).kind, HitKind::miss);
  }
}

TEST_F(Interval, BeginsBehindTheHit) {
  // From just behind the first hit on, the far side is the answer; the facet before and behind it doesn't matter.
  Random random(22);
  for (int k = 0; k < 500; ++k) {
    const Vec3 origin = 3 * normalized(random_direction(random));
    Ray one = ray(origin, 0.4 * random_direction(random) - origin);
    const Hit near = scene_.closest(one);
    ASSERT_EQ(near.kind, HitKind::hit);
    for (const double step : {1e-9, 1e-6, 1e-3}) {
      one.tnear = near.t + step;
      const Hit far = scene_.closest(one);
      ASSERT_EQ(far.kind, HitKind::hit) << step;
      EXPECT_GE(far.t, one.tnear);
      const double unit = length(one.direction), b = dot(one.origin, one.direction) / unit;
      const double exit = (-b + std::sqrt(b * b - dot(one.origin, one.origin) + 1)) / unit;
      EXPECT_NEAR(far.t, exit, 1e-9) << step;
    }
    one.tnear = near.t - 1e-9;
    EXPECT_NEAR(scene_.closest(one).t, near.t, 1e-12);
  }
}

TEST_F(Interval, OriginOnTheSurface) {
  Random random(23);
  for (int k = 0; k < 1000; ++k) {
    const Vec3 point = normalized(random_direction(random)), direction = normalized(random_direction(random));
    if (std::abs(dot(point, direction)) < 0.3) continue;  // a shorter chord may pass between facets and surface
    Ray one = ray(point, direction);
    one.tnear = 1e-9;
    const Hit hit = scene_.closest(one);
    const double chord = -2 * dot(point, direction);
    if (chord > 0) {
      ASSERT_EQ(hit.kind, HitKind::hit);
      EXPECT_NEAR(hit.t, chord, 1e-9);
    } else {
      EXPECT_EQ(hit.kind, HitKind::miss);
    }
  }
}

TEST(IntervalBegin, FacetsAtTheBeginningOfAPieceAreLeftBehind) {
  // Rays that leave the set from just outside are traced from as far back as facets may be wrong. Some then begin, in
  // float, on the flat facet itself, whose hit lies before their tnear.
  std::vector<Vec3> dome;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) dome.push_back({i / 2.0, j / 2.0, i == 1 && j == 1 ? 1.01 : 1.0});
  const std::vector<Vec3> flat{{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}};
  const PatchSet set =
      set_of({value_of(BezierPatch::polynomial(1, 1, flat)), value_of(BezierPatch::polynomial(2, 2, dome))});
  const RayScene scene = scene_of(set, 5);
  std::vector<Ray> rays;
  for (int k = 1; k < 500000; ++k) rays.push_back(ray({0.3, 0.6, -4e-8 * k}, {0, 0, -1}));
  for (const Hit& hit : closest(scene, rays)) ASSERT_EQ(hit.kind, HitKind::miss);
}

TEST_F(Interval, OccludedAgreesWithClosest) {
  Random random(24);
  std::vector<Ray> rays;
  for (int k = 0; k < 20000; ++k) {
    Ray one = ray(uniform_vector(random, -2, 2), random_direction(random));
    one.tfar = uniform(random, 0, 4);
    one.tnear = uniform(random, 0, one.tfar);
    rays.push_back(one);
  }
  const std::vector<Hit> hits = closest(scene_, rays);
  std::vector<std::uint8_t> occluded(rays.size());
  ASSERT_TRUE(scene_.occluded(rays, occluded).ok());
  std::size_t differ = 0, met = 0;
  for (std::size_t k = 0; k < rays.size(); ++k) {
    differ += (hits[k].kind == HitKind::hit) != (occluded[k] != 0);
    met += occluded[k];
  }
  // Only where facets and surface lie on different sides of an end or of a silhouette.
  EXPECT_LT(differ, rays.size() / 25);
  EXPECT_GT(met, rays.size() / 20);
}

TEST_F(Interval, SingleRaysAgreeWithBatches) {
  Random random(25);
  std::vector<Ray> rays;
  for (int k = 0; k < 3000; ++k) {
    const Vec3 target = uniform_vector(random, -0.8, 0.8);
    rays.push_back(ray({4, 0, 0}, target - Vec3{4, 0, 0}));  // coherent enough for packets
  }
  const std::vector<Hit> hits = closest(scene_, rays);
  for (std::size_t k = 0; k < rays.size(); ++k) {
    const Hit one = scene_.closest(rays[k]);
    ASSERT_EQ(one.kind, hits[k].kind);
    if (one.kind != HitKind::hit || one.flags.unrefined || hits[k].flags.unrefined) continue;
    EXPECT_NEAR(one.t, hits[k].t, 1e-9);
  }
}

/// Counts hits that rays with tfar = t, the hit's own t, do not have again.
std::size_t count_lost(const RayScene& scene, const std::vector<Ray>& rays) {
  const std::vector<Hit> hits = closest(scene, rays);
  std::size_t met = 0, lost = 0;
  for (std::size_t k = 0; k < rays.size(); ++k) {
    if (hits[k].kind != HitKind::hit) continue;
    ++met;
    Ray until = rays[k];
    until.tfar = hits[k].t;
    const Hit again = scene.closest(until);
    const bool is_same = again.t == hits[k].t || hits[k].flags.uncertified;
    lost += again.kind != HitKind::hit || again.t > hits[k].t || !is_same || scene.occluded(until) != HitKind::hit;
  }
  EXPECT_GT(met, rays.size() / 2);
  return lost;
}

TEST(ExactInterval, RaysThatEndAtAHitHaveItAgain) {
  Random random(26);
  for (const std::vector<BezierPatch>& patches :
       {sphere(), closed_body(), Torus(5).patches(true), lattice_body({3, 3, 0.2}, random)}) {
    const PatchSet set = set_of(patches);
    const RayScene scene = value_of(RayScene::make(set));
    const double size = set.box().diagonal();
    std::vector<Ray> rays;
    for (int k = 0; k < 1000; ++k) {
      rays.push_back(rays::at_surface(patches, random, size * uniform(random, 0.5, 2)));
      rays.push_back(through(beside_seam(patches, random, 1e-3), random, size));
      rays.push_back(rays::at_silhouette(patches, random, size));
    }
    EXPECT_EQ(count_lost(scene, rays), 0u);
  }
}

// Edges of shapes are hits at the nearest point of a loop, wherever that point's passage goes on behind the ray's end.
TEST(ExactInterval, RaysThatEndAtAnEdgeHaveItAgain) {
  Random random(27);
  for (const Shape& shape : {FrayedCube({1e-3}, 7).shape(), gaping_plate(1e-3), half_ball(1e-3)}) {
    const PatchSet set = value_of(make_patch_set(shape));
    const RayScene scene = value_of(RayScene::make(set));
    const EdgeTargets targets(shape);
    std::vector<Ray> rays;
    for (int k = 0; k < 5000; ++k) {
      const Vec3 eye = set.box().centre() + 3 * set.box().diagonal() * rays::unit_vector(random);
      rays.push_back(ray(eye, targets.draw(random) + 1e-3 * uniform_vector(random, -1, 1) - eye));
    }
    EXPECT_EQ(count_lost(scene, rays), 0u);
    const RayInstance instances[] = {{&scene, Affine::translated({1, 2, 3})}};
    const RayScene placed = value_of(RayScene::make(instances));
    for (Ray& moved : rays) moved.origin += Vec3{1, 2, 3};
    EXPECT_EQ(count_lost(placed, rays), 0u);
  }
}

// In grid mode t rounds by where the segment of the ray begins. Both ends are inclusive within that.
TEST_F(Interval, BeginsAtTheHit) {
  Random random(28);
  for (int k = 0; k < 2000; ++k) {
    const Vec3 target = normalized(random_direction(random));
    Ray one = ray(3 * target + random_direction(random), {});
    one.direction = target - one.origin;
    const Hit first = scene_.closest(one);
    ASSERT_EQ(first.kind, HitKind::hit);
    one.tnear = first.t;
    const Hit again = scene_.closest(one);
    ASSERT_EQ(again.kind, HitKind::hit);
    EXPECT_GE(again.t, one.tnear);
    EXPECT_NEAR(again.t, first.t, 1e-12);
  }
}

}}  // namespace tessera::test
