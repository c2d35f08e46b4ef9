#include "basis/exact_sign.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <span>

namespace tessera { namespace {

__extension__ using Wide = __int128;

/// The orientation of points whose coordinates are multiples of 2^-52 in [-1, 1], in integers: differences take 54
/// bits, their products 108.
int integer_orientation(const ParameterPoint& a, const ParameterPoint& b, const ParameterPoint& c) {
  const auto whole = [](double x) { return static_cast<Wide>(std::ldexp(x, 52)); };
  const Wide left = (whole(a.u) - whole(c.u)) * (whole(b.v) - whole(c.v));
  const Wide right = (whole(a.v) - whole(c.v)) * (whole(b.u) - whole(c.u));
  return left > right ? 1 : left < right ? -1 : 0;
}

double on_grid(double x) { return std::ldexp(std::nearbyint(std::ldexp(x, 52)), -52); }

TEST(ExactSign, OrientationAgreesWithIntegersNextToTheLine) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-0.5, 0.5);
  int zeros = 0, small = 0;
  for (int k = 0; k < 200000; ++k) {
    const ParameterPoint a{on_grid(uniform(random)), on_grid(uniform(random))};
    const ParameterPoint b{on_grid(uniform(random)), on_grid(uniform(random))};
    // A point within a few units of 2^-52 of the line, beyond its ends as well.
    const double t = 3 * uniform(random), s = std::ldexp(1.0, -static_cast<int>(random() % 55));
    const ParameterPoint c{on_grid(a.u + t * (b.u - a.u) + s * uniform(random)),
                           on_grid(a.v + t * (b.v - a.v) + s * uniform(random))};
    const int expected = integer_orientation(a, b, c);
    ASSERT_EQ(orientation(a, b, c), expected);
    ASSERT_EQ(exact_orientation(a, b, c), expected);
    ASSERT_EQ(orientation(b, c, a), expected);
    ASSERT_EQ(orientation(b, a, c), -expected);
    const double plain = (a.u - c.u) * (b.v - c.v) - (a.v - c.v) * (b.u - c.u);
    small += (plain > 0) - (plain < 0) != expected;
    zeros += expected == 0;
  }
  EXPECT_GT(small, 100) << "plain double decides all: the points are too far from the line";
  EXPECT_LT(zeros, 20000);
}

TEST(ExactSign, PointsOnTheLineHaveNoSide) {
  std::mt19937 random(2);
  std::uniform_int_distribution<int> whole(-1000, 1000);
  for (int k = 0; k < 10000; ++k) {
    const double du = whole(random), dv = whole(random), u = whole(random), v = whole(random);
    const double step = std::ldexp(1.0, -static_cast<int>(random() % 40));
    const auto at = [&](double t) { return ParameterPoint{u + t * step * du, v + t * step * dv}; };
    ASSERT_EQ(orientation(at(0), at(3), at(whole(random))), 0);
    if (du == 0 && dv == 0) continue;
    // Off the line by one unit in the last place.
    ParameterPoint off = at(whole(random));
    const bool along_u = std::abs(du) > std::abs(dv);
    double& moved = along_u ? off.v : off.u;
    moved = std::nextafter(moved, 1e9);
    ASSERT_EQ(orientation(at(0), at(3), off), along_u ? (du > 0 ? 1 : -1) : (dv > 0 ? -1 : 1));
  }
}

TEST(ExactSign, CoordinatesOfVeryDifferentSizes) {
  const ParameterPoint a{0, 0}, b{1e100, 1e100};
  EXPECT_EQ(orientation(a, b, {1, 1}), 0);
  EXPECT_EQ(orientation(a, b, {1, std::nextafter(1.0, 2)}), 1);
  EXPECT_EQ(orientation(a, b, {std::nextafter(1.0, 2), 1}), -1);
  EXPECT_EQ(orientation({-1e-90, 0}, b, {1e20, 1e20}), -1 * orientation(b, {-1e-90, 0}, {1e20, 1e20}));
  EXPECT_EQ(orientation(a, {1e100, 1}, {0, 1e-100}), 1);
  EXPECT_EQ(orientation(a, {1e100, 1}, {1e-100, 1e-300}), -1 * orientation({1e100, 1}, a, {1e-100, 1e-300}));
}

TEST(ExactSign, SumsThatCancel) {
  EXPECT_EQ(sign_of_sum({}), 0);
  EXPECT_EQ(sign_of_sum(std::array{0.0, 0.0}), 0);
  EXPECT_EQ(sign_of_sum(std::array{1e200, 1.0, -1e200}), 1);
  EXPECT_EQ(sign_of_sum(std::array{1.0, 1e200, 1e-200, -1.0, -1e200}), 1);
  EXPECT_EQ(sign_of_sum(std::array{1.0, 1e200, -1e-200, -1.0, -1e200}), -1);
  std::mt19937_64 random(3);
  for (int k = 0; k < 20000; ++k) {  // whole numbers below 2^112, and the last term cancels all but a few units
    std::array<double, 32> terms{};
    Wide sum = 0;
    for (std::size_t i = 0; i < 28; ++i) {
      const auto digits = static_cast<std::int64_t>(random()) >> 11;
      const int shift = static_cast<int>(random() % 55);
      terms[i] = std::ldexp(static_cast<double>(digits), shift);
      sum += static_cast<Wide>(digits) << shift;
    }
    Wide rest = sum + static_cast<int>(random() % 5) - 2;
    for (std::size_t i = 28; i < 32; ++i) {
      terms[i] = -static_cast<double>(rest);
      rest += static_cast<Wide>(terms[i]);
    }
    ASSERT_TRUE(rest == 0);
    for (const double term : std::span(terms).last(4)) sum += static_cast<Wide>(term);
    std::shuffle(terms.begin(), terms.end(), random);
    ASSERT_EQ(sign_of_sum(terms), sum > 0 ? 1 : sum < 0 ? -1 : 0);
  }
}

}}  // namespace tessera
