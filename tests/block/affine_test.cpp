// Affine maps: composition, rotations, the bound of their norm.

#include "tessera/geometry.h"

#include <gtest/gtest.h>

#include <numbers>

#include "support/random_patches.h"
#include "support/ulp.h"

namespace tessera::test { namespace {

Affine random_affine(Random& random) {
  return {.columns = {uniform_vector(random, -2, 2), uniform_vector(random, -2, 2), uniform_vector(random, -2, 2)},
          .translation = uniform_vector(random, -5, 5)};
}

TEST(Affine, ProductsMapByTheRightOneFirst) {
  Random random(11);
  for (int k = 0; k < 100; ++k) {
    const Affine a = random_affine(random), b = random_affine(random);
    const Vec3 p = uniform_vector(random, -1, 1);
    EXPECT_TRUE(within_units((a * b).point(p), a.point(b.point(p)), double_unit, 200));
    EXPECT_NEAR((a * b).determinant(), a.determinant() * b.determinant(),
                1e-12 * (1 + std::abs((a * b).determinant())));
  }
}

TEST(Affine, RotationsTurnCounterClockwiseAboutTheirAxis) {
  const Affine quarter = Affine::rotated({0, 0, 3}, std::numbers::pi / 2);
  EXPECT_TRUE(within_units(quarter.point({1, 0, 5}), {0, 1, 5}, double_unit, 2));
  EXPECT_EQ(Affine::rotated({}, 1), Affine{});
  Random random(12);
  for (int k = 0; k < 100; ++k) {
    const Vec3 axis = uniform_vector(random, -1, 1), p = uniform_vector(random, -1, 1);
    const Affine turn = Affine::rotated(axis, uniform(random, -7, 7));
    EXPECT_NEAR(length(turn.point(p)), length(p), 8 * double_unit);
    EXPECT_NEAR(turn.determinant(), 1, 8 * double_unit);
    EXPECT_TRUE(within_units(turn.point(axis), axis, double_unit, 8));
  }
}

TEST(Affine, NothingIsStretchedBeyondTheBoundOfTheNorm) {
  Random random(13);
  for (int k = 0; k < 1000; ++k) {
    const Affine map = random_affine(random);
    const Vec3 d = uniform_vector(random, -1, 1);
    EXPECT_LE(length(map.vector(d)), map.norm_bound() * length(d) * (1 + 4 * double_unit));
  }
  const Affine rigid = Affine::translated({1, 2, 3}) * Affine::rotated({1, 2, 3}, 0.7);
  EXPECT_NEAR(rigid.norm_bound(), 1, 8 * double_unit);
  EXPECT_DOUBLE_EQ(Affine::scaled({2, -3, 0.5}).norm_bound(), 3);
  EXPECT_DOUBLE_EQ(Affine::scaled({1e300, 1e-300, 1}).norm_bound(), 1e300);
  EXPECT_EQ(Affine::scaled({}).norm_bound(), 0);
}

}}  // namespace tessera::test
