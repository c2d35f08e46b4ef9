// Hits whose t, u, v are known: a plane, a hyperbolic paraboloid, the sphere.

#include <cmath>

#include "ray_support.h"

namespace tessera::test { namespace {

TEST(ClosedForm, FlatPatch) {
  const PatchSet set = set_of({polynomial(1, 1, {{0, 0, 0}, {0, 3, 0}, {2, 0, 0}, {2, 3, 0}})});
  const RayScene scene = scene_of(set, 3);
  Random random(1);
  for (int k = 0; k < 2000; ++k) {
    const double u = uniform(random, 0, 1), v = uniform(random, 0, 1);
    const Vec3 target{2 * u, 3 * v, 0}, origin = uniform_vector(random, -4, 4) + Vec3{0, 0, 6};
    const Hit hit = scene.closest(ray(origin, 0.7 * (target - origin)));
    ASSERT_EQ(hit.kind, HitKind::hit);
    EXPECT_FALSE(hit.flags.unrefined);
    EXPECT_NEAR(hit.t, 1 / 0.7, 1e-12);
    EXPECT_NEAR(hit.u, u, 1e-12);
    EXPECT_NEAR(hit.v, v, 1e-12);
    EXPECT_LT(length(hit.position - target), 1e-12);
    EXPECT_LT(length(hit.normal - Vec3{0, 0, 1}), 1e-15);
    EXPECT_LT(hit.residual, 1e-13);
  }
}

TEST(ClosedForm, FacetParametersRunAsThePatchDoes) {
  // Without refinement (u, v) is the facet's: on a bilinear patch with unequal sides a wrong order would show.
  const PatchSet set = set_of({polynomial(1, 1, {{0, 0, 0}, {0, 3, 0}, {2, 0, 0}, {2, 3, 0}})});
  const RayScene scene = scene_of(set, 5, false);
  for (const double u : {0.03, 0.41, 0.77}) {
    for (const double v : {0.12, 0.58, 0.93}) {
      const Hit hit = scene.closest(ray({2 * u, 3 * v, 2}, {0, 0, -1}));
      ASSERT_EQ(hit.kind, HitKind::hit);
      EXPECT_TRUE(hit.flags.unrefined);
      EXPECT_NEAR(hit.u, u, 1e-5);
      EXPECT_NEAR(hit.v, v, 1e-5);
      EXPECT_NEAR(hit.t, 2, 1e-5);
    }
  }
}

TEST(ClosedForm, HyperbolicParaboloid) {
  // (u, v, 2uv): the table of figures, second bilinear Coons patch.
  const PatchSet set = set_of({polynomial(1, 1, {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 2}})});
  const RayScene scene = scene_of(set, 4);
  Random random(2);
  for (int k = 0; k < 2000; ++k) {
    const double u = uniform(random, 0, 1), v = uniform(random, 0, 1);
    const Hit hit = scene.closest(ray({u, v, 5}, {0, 0, -2}));
    ASSERT_EQ(hit.kind, HitKind::hit);
    EXPECT_FALSE(hit.flags.unrefined);
    EXPECT_NEAR(hit.t, (5 - 2 * u * v) / 2, 1e-13);
    EXPECT_NEAR(hit.u, u, 1e-13);
    EXPECT_NEAR(hit.v, v, 1e-13);
    EXPECT_LT(length(hit.normal - normalized({-2 * v, -2 * u, 1})), 1e-12);
  }
}

TEST(ClosedForm, SourceDomains) {
  const BezierPatch patch = polynomial(1, 1, {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}});
  const PatchSource source{5, {2, 4, -1, 3}};
  const PatchSet set = value_of(PatchSet::make(std::span(&patch, 1), {.sources = std::span(&source, 1)}));
  const Hit hit = scene_of(set).closest(ray({0.25, 0.75, 1}, {0, 0, -1}));
  ASSERT_EQ(hit.kind, HitKind::hit);
  EXPECT_EQ(hit.surface, 5u);
  EXPECT_EQ(hit.patch, 0u);
  EXPECT_NEAR(hit.patch_u, 0.25, 1e-13);
  EXPECT_NEAR(hit.patch_v, 0.75, 1e-13);
  EXPECT_NEAR(hit.u, 2.5, 1e-12);
  EXPECT_NEAR(hit.v, 2, 1e-12);
}

/// The distance along a unit direction to the unit sphere from inside.
double exit_of_sphere(const Vec3& origin, const Vec3& unit) {
  const double b = dot(origin, unit);
  return -b + std::sqrt(b * b - dot(origin, origin) + 1);
}

TEST(ClosedForm, SphereFromInside) {
  const PatchSet set = set_of(sphere());
  const RayScene scene = scene_of(set);
  Random random(3);
  std::vector<Ray> rays;
  for (int k = 0; k < 50000; ++k)
    rays.push_back(ray(0.8 * random_direction(random), normalized(random_direction(random))));
  const std::vector<Hit> hits = closest(scene, rays);
  std::size_t unrefined = 0;
  for (std::size_t k = 0; k < rays.size(); ++k) {
    ASSERT_EQ(hits[k].kind, HitKind::hit) << k;
    unrefined += hits[k].flags.unrefined;
    if (hits[k].flags.unrefined) continue;
    EXPECT_NEAR(hits[k].t, exit_of_sphere(rays[k].origin, rays[k].direction), 1e-9) << k;
    EXPECT_NEAR(length(hits[k].position), 1, 1e-12) << k;
    EXPECT_LT(length(cross(hits[k].normal, hits[k].position)), 1e-6) << k;
    EXPECT_NEAR(length(hits[k].normal), 1, 1e-12) << k;
    EXPECT_LT(hits[k].residual, 1e-9) << k;
  }
  EXPECT_EQ(unrefined, 0u);
}

TEST(ClosedForm, SphereAtItsPoles) {
  const PatchSet set = set_of(sphere());
  const RayScene scene = scene_of(set);
  for (const double z : {3.0, -3.0}) {
    for (const double off : {0.0, 1e-12, 1e-7, 1e-4, 1e-2}) {
      const Hit hit = scene.closest(ray({off, 0.7 * off, z}, {0, 0, -z}));
      ASSERT_EQ(hit.kind, HitKind::hit) << off;
      EXPECT_FALSE(hit.flags.unrefined) << off;
      const double height = std::sqrt(1 - 1.49 * off * off);
      EXPECT_NEAR(hit.t, (3 - height) / 3, 1e-9) << off;
      EXPECT_LT(length(hit.normal - Vec3{0, 0, 1}) * length(hit.normal + Vec3{0, 0, 1}), 3 * off + 1e-6) << off;
    }
  }
}

/// One light weight makes a crater that the facets follow coarsely: rays at known points of the surface must still be
/// answered there.
TEST(ClosedForm, LightWeightsDoNotMoveTheRaysAway) {
  for (const double weight : {1.0, 1e-2, 1e-4, 1e-6, 1e-7, 1e-8}) {
    std::vector<Vec3> points;
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j) points.push_back({i / 3.0, j / 3.0, 0.1 * ((i * 7 + j * 5) % 3)});
    std::vector<double> weights(16, 1.0);
    weights[5] = weight;
    const BezierPatch patch = value_of(BezierPatch::rational(3, 3, points, weights));
    const PatchSet set = value_of(PatchSet::make(std::span(&patch, 1)));
    const RayScene scene = value_of(RayScene::make(set));
    for (int k = 0; k < 400; ++k) {
      const double u = 0.02 + 0.96 * (k % 20) / 19, v = 0.02 + 0.96 * (k / 20) / 19;
      const Vec3 target = de_casteljau(patch, u, v), direction{0.3 * u - 0.15, 0.15 - 0.3 * v, -1};
      const Hit hit = scene.closest({.origin = target - 5 * direction, .direction = direction});
      ASSERT_EQ(hit.kind, HitKind::hit) << weight;
      EXPECT_LE(length(hit.position - target), 1e-9) << weight;
    }
  }
}

}}  // namespace tessera::test
