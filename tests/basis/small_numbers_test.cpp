// Symmetric 3 x 3 matrices, and sums of two doubles.

#include "basis/double_double.h"
#include "basis/symmetric_eigen.h"
#include "support/random_patches.h"

namespace tessera::test { namespace {

TEST(SymmetricEigen, IsTheMatrixAgain) {
  Random random(1);
  for (int k = 0; k < 2000; ++k) {
    double a[6];
    for (double& x : a) x = k % 3 ? uniform(random, -1, 1) : std::pow(10, uniform(random, -12, 0));
    const SymmetricEigen eigen = symmetric_eigen(a[0], a[1], a[2], a[3], a[4], a[5]);
    const Vec3 columns[] = {{a[0], a[3], a[5]}, {a[3], a[1], a[4]}, {a[5], a[4], a[2]}};
    const Vec3 axes[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int c = 0; c < 3; ++c) {
      Vec3 sum;
      for (std::size_t i = 0; i < 3; ++i) sum += eigen.values[i] * dot(eigen.vectors[i], axes[c]) * eigen.vectors[i];
      EXPECT_LT(max_abs(sum - columns[c]), 2e-15);
    }
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) EXPECT_NEAR(dot(eigen.vectors[i], eigen.vectors[j]), i == j, 1e-15);
  }
}

TEST(SymmetricEigen, DiagonalMatricesComeBack) {
  const SymmetricEigen eigen = symmetric_eigen(3, -1, 0, 0, 0, 0);
  EXPECT_EQ(eigen.values, (std::array<double, 3>{3, -1, 0}));
  EXPECT_EQ(eigen.vectors[0], (Vec3{1, 0, 0}));
  EXPECT_EQ(eigen.vectors[1], (Vec3{0, 1, 0}));
  EXPECT_EQ(eigen.vectors[2], (Vec3{0, 0, 1}));
}

TEST(DoubleDouble, KeepsWhatDoublesLose) {
  const DoubleDouble big{1e16, 0}, small{1, 0};
  EXPECT_EQ((big + small + DoubleDouble{-1e16, 0}).rounded(), 1);
  EXPECT_EQ(((DoubleDouble{1 + 0x1p-52, 0} * (1 - 0x1p-52)) + DoubleDouble{-1, 0}).rounded(), -0x1p-104);
  const DoubleDouble third = DoubleDouble{1, 0} / 3;
  EXPECT_NEAR((third * 3 + DoubleDouble{-1, 0}).rounded(), 0, 0x1p-104);
  EXPECT_NEAR((third * third * 9 + DoubleDouble{-1, 0}).rounded(), 0, 0x1p-102);
}

}}  // namespace tessera::test
