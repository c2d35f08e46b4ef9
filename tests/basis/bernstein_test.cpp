#include "basis/bernstein.h"

#include <array>

#include "support/random_patches.h"
#include "support/reference.h"

namespace tessera::test { namespace {

using Values = std::array<double, max_degree + 1>;
constexpr double parameters[] = {0, 0x1p-60, 0.01, 0.25, 1.0 / 3, 0.5, 0.7, 0.999, 1 - 0x1p-53, 1};

/// All three orders at once.
struct Bernstein {
  Bernstein(int degree, double t) {
    bernstein_values(degree, t, value.data());
    bernstein_derivatives(degree, t, first.data());
    bernstein_second_derivatives(degree, t, second.data());
  }
  Values value{}, first{}, second{};
};

double sum(const Values& values, int degree, double (*weight)(int i, int degree)) {
  double total = 0;
  for (int i = 0; i <= degree; ++i) total += weight(i, degree) * values[static_cast<std::size_t>(i)];
  return total;
}

TEST(Binomial, PascalsTriangle) {
  for (int n = 1; n <= 30; ++n)
    for (int k = 0; k <= n; ++k) EXPECT_EQ(binomial(n, k), binomial(n - 1, k - 1) + binomial(n - 1, k));
  EXPECT_EQ(binomial(15, 7), 6435);
  EXPECT_EQ(binomial(3, -1), 0);
  EXPECT_EQ(binomial(3, 4), 0);
}

TEST(Bernstein, ExactAtTheEnds) {
  for (int n = 0; n <= max_degree; ++n) {
    const Bernstein at_0(n, 0), at_1(n, 1);
    for (int i = 0; i <= n; ++i) {
      EXPECT_EQ(at_0.value[static_cast<std::size_t>(i)], i == 0);
      EXPECT_EQ(at_1.value[static_cast<std::size_t>(i)], i == n);
      EXPECT_EQ(at_0.first[static_cast<std::size_t>(i)], i == 0 ? -n : i == 1 ? n : 0);
      EXPECT_EQ(at_1.first[static_cast<std::size_t>(i)], i == n ? n : i == n - 1 ? -n : 0);
    }
  }
}

TEST(Bernstein, PartitionOfUnityAndLinearPrecision) {
  const auto one = [](int, int) { return 1.0; };
  const auto abscissa = [](int i, int n) { return static_cast<double>(i) / n; };
  for (int n = 1; n <= max_degree; ++n)
    for (const double t : parameters) {
      const Bernstein b(n, t);
      EXPECT_NEAR(sum(b.value, n, one), 1, 4 * 0x1p-52);
      EXPECT_NEAR(sum(b.first, n, one), 0, 8 * n * 0x1p-52);
      EXPECT_NEAR(sum(b.second, n, one), 0, 16 * n * n * 0x1p-52);
      EXPECT_NEAR(sum(b.value, n, abscissa), t, 4 * 0x1p-52);
      EXPECT_NEAR(sum(b.first, n, abscissa), 1, 8 * n * 0x1p-52);
      EXPECT_NEAR(sum(b.second, n, abscissa), 0, 16 * n * n * 0x1p-52);
    }
}

TEST(Bernstein, AgreesWithTheDefinition) {
  for (int n = 0; n <= max_degree; ++n)
    for (const double t : parameters) {
      const Bernstein b(n, t);
      for (int i = 0; i <= n; ++i) {
        const std::size_t k = static_cast<std::size_t>(i);
        const double value = static_cast<double>(reference_bernstein(n, i, t));
        EXPECT_GE(b.value[k], 0);
        EXPECT_NEAR(b.value[k], value, std::max(3 * n, 1) * 0x1p-53 * value) << "degree " << n << " at " << t;
        EXPECT_NEAR(b.first[k], static_cast<double>(reference_bernstein(n, i, t, 1)), 4 * n * 0x1p-52);
        EXPECT_NEAR(b.second[k], static_cast<double>(reference_bernstein(n, i, t, 2)), 16 * n * n * 0x1p-52);
      }
    }
}

TEST(Bernstein, SymmetricAtExactParameters) {
  for (int n = 1; n <= max_degree; ++n)
    for (const double t : {0.0, 0.125, 0.25, 0.375, 0.5}) {
      const Bernstein b(n, t), mirror(n, 1 - t);
      for (int i = 0; i <= n; ++i) {
        const std::size_t k = static_cast<std::size_t>(i), l = static_cast<std::size_t>(n - i);
        EXPECT_NEAR(b.value[k], mirror.value[l], 3 * n * 0x1p-53 * b.value[k]);
        EXPECT_NEAR(b.first[k], -mirror.first[l], 4 * n * 0x1p-52);
      }
    }
}

}}  // namespace tessera::test
