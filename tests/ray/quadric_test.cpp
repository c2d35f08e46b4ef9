// Compares patches of quadrics with the closed form: the same first hit, at the same parameters.

#include <cmath>

#include "ray_support.h"
#include "support/quadrics.h"
#include "tessera/convert.h"
#include "tessera/model.h"

namespace tessera::test { namespace {

/// The nearest hit of the piece in front of the ray, and whether facets must find it, which they must if every hit is
/// away from the piece's borders and from grazing, and no two are close together.
struct FirstHit {
  double t = 0;
  QuadricParameters at;
  bool plain = false;
};
FirstHit first_hit(const QuadricPiece& part, const Ray& ray) {
  const QuadricHits hits = intersect(part, ray.origin, ray.direction);
  FirstHit first;
  const bool doubled = part.quadric().kind() == QuadricKind::coincident_planes;  // every root is a double one
  first.plain = hits.count > 0 && hits.tangent == doubled && !(hits.count == 2 && hits.t[1] - hits.t[0] < 0.2);
  for (int k = hits.count - 1; k >= 0; --k) {
    first.t = hits.t[static_cast<std::size_t>(k)];
    const auto at = part.locate(ray.origin + first.t * ray.direction);
    if (!at || first.t < 0) return {};
    first.at = *at;
    const Domain& r = part.range();
    const double s = r.local_u(at->u), t = r.local_v(at->v);
    const SurfaceJet jet = evaluate_jet(part, at->u, at->v);
    const double slope = dot(normalized(cross(jet.du, jet.dv)), ray.direction);
    first.plain = first.plain && std::min(s, t) > 0.02 && std::max(s, t) < 0.98 && std::abs(slope) > 0.2;
  }
  return first;
}

TEST(QuadricRays, PatchesAreMetWhereTheClosedFormSays) {
  Random random(1);
  for (const QuadricSample& sample : quadric_samples())
    for (int sheet = 0; sheet < sheet_count(sample.kind); ++sheet) {
      const Quadric surface = quadric(moved(sample.coefficients, random_frame(random, 1)));
      const QuadricPiece part = piece(surface, sample_range(sample.kind), sheet);
      const PatchGrid grid = value_of(to_bezier(part));
      const PatchSet set = value_of(make_patch_set(std::span(&grid, 1)));
      const RayScene scene = scene_of(set, 32);
      const Domain& r = part.range();
      int plain = 0;
      for (int k = 0; k < 300; ++k) {
        const Vec3 target = evaluate_jet(part, uniform(random, r.u0, r.u1), uniform(random, r.v0, r.v1)).position;
        const Vec3 direction = normalized(random_direction(random));
        const Ray aimed = ray(target - uniform(random, 20, 60) * direction, direction);
        const FirstHit expected = first_hit(part, aimed);
        if (!expected.plain) continue;
        ++plain;
        const Hit hit = scene.closest(aimed);
        ASSERT_EQ(hit.kind, HitKind::hit) << name(sample.kind);
        EXPECT_FALSE(hit.flags.unrefined);
        EXPECT_NEAR(hit.t, expected.t, 1e-10) << name(sample.kind);
        const QuadricParameters at = canonical_parameters(part, hit.u, hit.v);
        EXPECT_LT(max_abs(evaluate_jet(part, at.u, at.v).position - (aimed.origin + expected.t * direction)), 1e-10);
      }
      EXPECT_GT(plain, 60) << name(sample.kind);
    }
}

}}  // namespace tessera::test
