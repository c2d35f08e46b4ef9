#pragma once
// The patches that accuracy tests use: random nets of a degree, at difficult places and sizes.

#include <vector>

#include "support/random_patches.h"

namespace tessera::test {

/// Where a set of patches lies: its size, how many sizes its centre is from zero, and how far its weights range.
struct Circumstance {
  double size, distance, lowest_weight, highest_weight;
};
inline constexpr Circumstance circumstances[] = {{1, 0, 0.25, 4},      {1, 0, 1e-3, 1e3},   {1e-6, 0, 1e-3, 1e3},
                                                 {1e6, 0, 1e-3, 1e3},  {1, 1e7, 1e-3, 1e3}, {1e-6, 1e3, 1e-3, 1e3},
                                                 {1e-6, 1e7, 0.25, 4}, {1e6, 1e7, 0.25, 4}};

/// `count` patches, one direction of `degree`, the other of any degree up to it; every other patch is rational.
inline std::vector<BezierPatch> patches_of_degree(Random& random, int degree, int count, const Circumstance& where) {
  const Vec3 centre = where.distance * where.size * Vec3{1, -0.6, 0.3};
  std::vector<BezierPatch> patches;
  for (int k = 0; k < count; ++k) {
    const int other = 1 + static_cast<int>(random() % static_cast<unsigned>(degree));
    const int m = k / 2 % 2 ? degree : other, n = k / 2 % 2 ? other : degree;
    patches.push_back(k % 2
                          ? random_rational(random, m, n, where.lowest_weight, where.highest_weight, centre, where.size)
                          : random_polynomial(random, m, n, centre, where.size));
  }
  return patches;
}

/// The patch about `origin`: exact in double if its points are farther from zero than from `origin`.
inline BezierPatch relative_to(const BezierPatch& patch, const Vec3& origin) {
  std::vector<Vec3> points(patch.points().begin(), patch.points().end());
  for (Vec3& p : points) p = p - origin;
  if (!patch.is_rational()) return polynomial(patch.degree_u(), patch.degree_v(), points);
  return rational(patch.degree_u(), patch.degree_v(), points, {patch.weights().begin(), patch.weights().end()});
}

}  // namespace tessera::test
