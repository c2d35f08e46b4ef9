// Interpolation at Chebyshev-Lobatto parameters: exact for polynomials, and no worse than its bounds say.

#include "basis/chebyshev_lobatto.h"

#include <gtest/gtest.h>

#include <cmath>

#include "basis/bernstein.h"

namespace tessera::test { namespace {

TEST(ChebyshevLobatto, ParametersRunFromEndToEnd) {
  for (int n = 1; n <= 15; ++n) {
    const auto x = lobatto_parameters(n);
    ASSERT_EQ(x.size(), static_cast<std::size_t>(n + 1));
    EXPECT_EQ(x.front(), 0);
    EXPECT_EQ(x.back(), 1);
    for (std::size_t i = 0; i + 1 < x.size(); ++i) EXPECT_LT(x[i], x[i + 1]);
    for (std::size_t i = 0; i < x.size(); ++i) EXPECT_NEAR(x[i] + x[x.size() - 1 - i], 1, 1e-15);
    EXPECT_EQ(lobatto_parameter(x, 0, -3, 7), -3);
    EXPECT_EQ(lobatto_parameter(x, x.size() - 1, 0.1, 0.7), 0.7);
  }
  EXPECT_NEAR(lobatto_parameters(3)[1], 0.25, 1e-16);
}

TEST(ChebyshevLobatto, ReproducesPolynomials) {
  for (int n = 1; n <= 15; ++n) {
    const auto x = lobatto_parameters(n);
    const Matrix matrix = lobatto_to_bernstein(n);
    for (int j = 0; j <= n; ++j) {
      EXPECT_EQ(matrix(0, j), j == 0 ? 1 : 0);
      EXPECT_EQ(matrix(n, j), j == n ? 1 : 0);
    }
    for (int k = 0; k <= n; ++k)  // B_k, whose coefficients are those of the identity
      for (int i = 0; i <= n; ++i) {
        long double sum = 0;
        for (int j = 0; j <= n; ++j) {
          std::vector<long double> b(static_cast<std::size_t>(n + 1));
          bernstein_values(n, static_cast<long double>(x[static_cast<std::size_t>(j)]), b.data());
          sum += matrix(i, j) * b[static_cast<std::size_t>(k)];
        }
        EXPECT_NEAR(static_cast<double>(sum), i == k ? 1 : 0, 1e-15) << n;
      }
    const double parameters[] = {0.1, 0.77};
    const Matrix values = lobatto_evaluation(n, parameters);
    for (int r = 0; r < 2; ++r) {
      long double sum = 0;
      for (int j = 0; j <= n; ++j)
        sum += values(r, j) * std::pow(static_cast<long double>(x[static_cast<std::size_t>(j)]), n);
      EXPECT_NEAR(static_cast<double>(sum), std::pow(parameters[r], n), 1e-16);
    }
  }
}

TEST(ChebyshevLobatto, BoundsAreTrueAndSharp) {
  for (int n = 1; n <= 15; ++n) {
    const auto x = lobatto_parameters(n);
    double largest_product = 0, largest_sum = 0;
    for (int k = 0; k <= 5000; ++k) {
      const double t = k / 5000.0;
      double product = 1, sum = 0;
      for (std::size_t i = 0; i < x.size(); ++i) {
        product *= std::abs(t - x[i]) / static_cast<double>(i + 1);
        double lagrange = 1;
        for (std::size_t j = 0; j < x.size(); ++j)
          if (j != i) lagrange *= (t - x[j]) / (x[i] - x[j]);
        sum += std::abs(lagrange);
      }
      largest_product = std::max(largest_product, product);
      largest_sum = std::max(largest_sum, sum);
    }
    EXPECT_LE(largest_product, lobatto_error_factor(n)) << n;
    EXPECT_GE(largest_product, 0.75 * lobatto_error_factor(n)) << n;
    EXPECT_LE(largest_sum, lobatto_lebesgue_constant(n)) << n;
    EXPECT_GE(largest_sum, 0.65 * lobatto_lebesgue_constant(n)) << n;
  }
}

TEST(ChebyshevLobatto, RoundingStaysSmall) {
  // At least that of the points themselves, and near it for low degrees, in long doubles of 64 bits.
  for (int n = 1; n <= 15; ++n) EXPECT_GE(lobatto_to_bernstein_rounding(n, 1, 1), 0x1p-53);
  EXPECT_LT(lobatto_to_bernstein_rounding(3, 1, 1), 1.3 * 0x1p-53);
  EXPECT_LT(lobatto_to_bernstein_rounding(5, 1, 1), 5 * 0x1p-53);
  EXPECT_LT(lobatto_to_bernstein_rounding(15, 1, 1), 1e-9);
}

}}  // namespace tessera::test
