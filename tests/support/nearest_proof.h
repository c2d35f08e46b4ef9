#pragma once
// Compares nearest points with a search that shares no code, in classes of difficult surfaces and places.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "support/nearest_reference.h"
#include "support/ray_classes.h"
#include "tessera/nearest_points.h"

namespace tessera::test {

/// Counts of the nearest points of a class.
struct NearestTally {
  std::size_t points = 0, certified = 0;
  std::size_t missed = 0;         ///< points without a nearest one
  std::size_t wrong = 0;          ///< certified ones than which the reference is nearer
  std::size_t off = 0;            ///< positions or distances that are not those of the parameters
  std::size_t far_from_best = 0;  ///< any that are farther than the reference by 1e-6 of the size
  double worst = 0;               ///< how much nearer the reference is than certified ones, shares of the size

  void add(const NearestTally& other) {
    points += other.points, certified += other.certified, missed += other.missed, wrong += other.wrong;
    off += other.off, far_from_best += other.far_from_best, worst = std::max(worst, other.worst);
  }
};

/// A point on a ray, which passes near the places where the class is difficult.
inline Vec3 near_point(const Ray& ray, Random& random, double size) {
  const Vec3 aimed = ray.origin + uniform(random, 0, 2) * ray.direction;
  return random() % 4 == 0 ? aimed + size * rays::power(random, 1e-9, 0.3) * rays::unit_vector(random) : aimed;
}

/// Compares nearest points of a class with reference_distance().
inline NearestTally nearest_tally(const RayClass& of, std::size_t count, std::uint64_t seed) {
  Random random(seed);
  const PatchSet set = value_of(PatchSet::make(of.patches));
  const PointScene scene = value_of(PointScene::make(set));
  const double size = set.box().diagonal();
  NearestTally tally;
  for (std::size_t k = 0; k < count; ++k) {
    const Vec3 point = near_point(of.draw(random), random, size);
    const NearestPoint found = scene.nearest(point);
    ++tally.points;
    if (found.kind != NearestKind::found) {
      ++tally.missed;
      continue;
    }
    tally.certified += found.flags.certified;
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

}  // namespace tessera::test
