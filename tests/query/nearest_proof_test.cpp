// Compares nearest points with a search that shares no code, in classes of difficult surfaces and places.

#include <gtest/gtest.h>

#include "support/nearest_reference.h"
#include "support/ray_classes.h"
#include "tessera/nearest_points.h"

namespace tessera::test { namespace {

/// What nearest points of a class showed.
struct NearestTally {
  std::size_t points = 0, certified = 0, wrong = 0, off = 0, far_from_best = 0;
  double worst = 0;  ///< how much nearer the reference is, shares of the size
};

/// A point on a ray, which passes near the places where the class is difficult.
Vec3 point_of(const Ray& ray, Random& random, double size) {
  const Vec3 aimed = ray.origin + uniform(random, 0, 2) * ray.direction;
  return random() % 4 == 0 ? aimed + size * rays::power(random, 1e-9, 0.3) * rays::unit_vector(random) : aimed;
}

NearestTally tally_of(const RayClass& of, std::size_t count, std::uint64_t seed) {
  Random random(seed);
  const PatchSet set = value_of(PatchSet::make(of.patches));
  const PointScene scene = value_of(PointScene::make(set));
  const double size = set.box().diagonal();
  NearestTally tally;
  for (std::size_t k = 0; k < count; ++k) {
    const Vec3 point = point_of(of.draw(random), random, size);
    const NearestPoint found = scene.nearest(point);
    EXPECT_EQ(found.kind, NearestKind::found);
    if (found.kind != NearestKind::found) continue;
    ++tally.points, tally.certified += found.flags.certified;
    const Vec3 there = de_casteljau(of.patches[found.patch], found.patch_u, found.patch_v);
    const double reach = size + length(point - set.box().centre());
    tally.off +=
        !(length(there - found.position) <= 1e-13 * size + 1e-15 * length(there)) ||
        !(std::abs(length(point - there) - found.distance) <= found.rounding + 1e-14 * reach + 1e-15 * length(there));
    const double best = reference_distance(of.patches, point, 1e-14 * size * size);
    const double beyond = found.distance - best;
    tally.far_from_best += beyond > 1e-6 * size;
    if (!found.flags.certified) continue;
    tally.worst = std::max(tally.worst, beyond / size);
    tally.wrong += beyond > found.rounding + 1e-14 * reach;
  }
  return tally;
}

TEST(NearestProof, NothingIsNearer) {
  for (const RayClass& of : ray_classes()) {
    SCOPED_TRACE(of.name);
    const NearestTally tally = tally_of(of, 150, 3);
    EXPECT_EQ(tally.wrong, 0u) << tally.worst;
    EXPECT_EQ(tally.off, 0u);
    EXPECT_EQ(tally.far_from_best, 0u);
    EXPECT_GE(double(tally.certified), 0.99 * double(tally.points));
  }
}

}}  // namespace tessera::test
