#include "basis/small_matrix.h"

#include <cmath>

#include "support/random_patches.h"

namespace tessera::test { namespace {

Matrix random_matrix(Random& random, int rows, int columns) {
  Matrix matrix(rows, columns);
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j) matrix(i, j) = uniform(random, -1, 1);
  return matrix;
}

TEST(SmallMatrix, InverseTimesMatrixIsTheIdentity) {
  Random random(1);
  for (int size = 1; size <= 16; ++size) {
    const Matrix a = random_matrix(random, size, size);
    const auto b = inverse(a);
    ASSERT_TRUE(b.has_value());
    for (const Matrix& product : {a * *b, *b * a})
      for (int i = 0; i < size; ++i)
        for (int j = 0; j < size; ++j) EXPECT_NEAR(static_cast<double>(product(i, j)), i == j, 1e-14);
  }
}

TEST(SmallMatrix, ZeroPivotsAreSwappedAway) {
  Matrix permutation(3, 3);
  permutation(0, 1) = permutation(1, 2) = permutation(2, 0) = 1;
  const auto b = inverse(permutation);
  ASSERT_TRUE(b.has_value());
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) EXPECT_EQ((*b)(i, j), permutation(j, i));
}

TEST(SmallMatrix, SingularOnesHaveNoInverse) {
  Random random(2);
  for (int size = 3; size <= 16; ++size) {
    Matrix a = random_matrix(random, size, size);
    for (int i = 0; i < size; ++i) a(i, size - 1) = a(i, 0) - 0.5L * a(i, size / 2);
    EXPECT_FALSE(inverse(a).has_value()) << size;
    for (int i = 0; i < size; ++i) a(i, 0) = 0;
    EXPECT_FALSE(inverse(a).has_value()) << size;
  }
  Matrix bad = Matrix::identity(2);
  bad(0, 0) = std::numeric_limits<long double>::infinity();
  EXPECT_FALSE(inverse(bad).has_value());
}

TEST(SmallMatrix, TensorProductIsTheDoubleSum) {
  Random random(3);
  const Matrix a = random_matrix(random, 5, 3), b = random_matrix(random, 2, 4);
  const std::vector<Vec3> net = random_points(random, 2, 3);
  const std::vector<Vec3> product = tensor_product(a, net, b);
  ASSERT_EQ(product.size(), 10u);
  for (int i = 0; i < 5; ++i)
    for (int j = 0; j < 2; ++j) {
      long double sum = 0;
      for (int k = 0; k < 3; ++k)
        for (int l = 0; l < 4; ++l) sum += a(i, k) * b(j, l) * net[static_cast<std::size_t>(4 * k + l)].y;
      EXPECT_NEAR(product[static_cast<std::size_t>(2 * i + j)].y, static_cast<double>(sum), 0x1p-52);
    }
}

}}  // namespace tessera::test
