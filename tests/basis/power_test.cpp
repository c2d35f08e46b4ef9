#include "basis/power.h"

#include <array>

#include "support/random_patches.h"
#include "support/reference.h"

namespace tessera::test { namespace {

using Values = std::array<double, max_degree + 1>;

TEST(Power, ExactAtZeroOneAndTwo) {
  for (int n = 0; n <= max_degree; ++n) {
    Values at_0{}, at_1{}, at_2{}, slope{};
    power_values(n, 0.0, at_0.data());
    power_values(n, 1.0, at_1.data());
    power_values(n, 2.0, at_2.data());
    power_derivatives(n, 2.0, slope.data());
    for (int i = 0; i <= n; ++i) {
      const std::size_t k = static_cast<std::size_t>(i);
      EXPECT_EQ(at_0[k], i == 0);
      EXPECT_EQ(at_1[k], 1);
      EXPECT_EQ(at_2[k], std::ldexp(1, i));
      EXPECT_EQ(slope[k], i * std::ldexp(1, i - 1));
    }
  }
}

TEST(Power, AgreesWithLongDouble) {
  Random random(7);
  for (int round = 0; round < 1000; ++round) {
    const double t = uniform(random, -1, 2);
    Values value{}, slope{}, bend{};
    power_values(max_degree, t, value.data());
    power_derivatives(max_degree, t, slope.data());
    power_second_derivatives(max_degree, t, bend.data());
    for (int i = 0; i <= max_degree; ++i) {
      const std::size_t k = static_cast<std::size_t>(i);
      const double expected = static_cast<double>(reference_power(t, i));
      EXPECT_NEAR(value[k], expected, 0.5 * (i + 1) * 0x1p-52 * std::abs(expected));
      const double expected_slope = i == 0 ? 0 : static_cast<double>(i * reference_power(t, i - 1));
      EXPECT_NEAR(slope[k], expected_slope, 0.5 * (i + 1) * 0x1p-52 * std::abs(expected_slope));
      const double expected_bend = i < 2 ? 0 : static_cast<double>(i * (i - 1) * reference_power(t, i - 2));
      EXPECT_NEAR(bend[k], expected_bend, 0.5 * (i + 1) * 0x1p-52 * std::abs(expected_bend));
    }
  }
}

}}  // namespace tessera::test
