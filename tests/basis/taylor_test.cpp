// Compares series of functions with closed forms, identities and, in intervals, the series at the numbers within.

#include "tessera/detail/taylor.h"

#include <functional>

#include "support/random_patches.h"

namespace tessera::test { namespace {

using TaylorSeries = Taylor<double, 5>;
using RealSeries = Taylor<long double, 5>;

/// A series with all coefficients, with a value in [from, to).
TaylorSeries random_series(Random& random, double from, double to) {
  const TaylorSeries u = TaylorSeries::variable(0, 0), v = TaylorSeries::variable(0, 1);
  TaylorSeries sum = uniform(random, from, to), power_u = 1;
  for (int i = 0; i <= 5; ++i, power_u *= u) {
    TaylorSeries power = power_u;
    for (int j = 0; i + j <= 5; ++j, power *= v)
      if (i + j > 0) sum += uniform(random, -1, 1) * power;
  }
  return sum;
}

void expect_same(const TaylorSeries& a, const TaylorSeries& b, double tolerance, const char* what) {
  for (int i = 0; i <= 5; ++i)
    for (int j = 0; i + j <= 5; ++j)
      EXPECT_NEAR(a.coefficient(i, j), b.coefficient(i, j), tolerance) << what << " " << i << " " << j;
}

TEST(Taylor, DerivativesOfAnExponential) {
  const double u = 0.3, v = -0.7;
  const TaylorSeries e = exp(2 * TaylorSeries::variable(u, 0) - 3 * TaylorSeries::variable(v, 1));
  const double value = std::exp(2 * u - 3 * v);
  for (int i = 0; i <= 5; ++i)
    for (int j = 0; i + j <= 5; ++j)
      EXPECT_NEAR(e.derivative(i, j) / (std::pow(2, i) * std::pow(-3, j) * value), 1, 1e-14);
}

TEST(Taylor, DerivativesOfAMonomialAndAWave) {
  const TaylorSeries u = TaylorSeries::variable(2, 0), v = TaylorSeries::variable(-1, 1);
  const TaylorSeries p = 3 * u * u * v * v * v;
  EXPECT_EQ(p.value(), -12);
  EXPECT_EQ(p.derivative(2, 0), -6);
  EXPECT_EQ(p.derivative(1, 1), 36);
  EXPECT_EQ(p.derivative(0, 2), -72);
  EXPECT_EQ(p.derivative(2, 3), 36);
  EXPECT_EQ(p.derivative(3, 0), 0);
  const TaylorSeries w = sin(u * v);  // d^2/du^2 = -v^2 sin, d^2/du dv = cos - uv sin
  EXPECT_NEAR(w.derivative(2, 0), -std::sin(-2.0), 1e-15);
  EXPECT_NEAR(w.derivative(1, 1), std::cos(-2.0) + 2 * std::sin(-2.0), 1e-15);
  EXPECT_NEAR(w.derivative(0, 3), -8 * std::cos(-2.0), 1e-14);
}

TEST(Taylor, FunctionsKeepTheirIdentities) {
  Random random(3);
  for (int k = 0; k < 20; ++k) {
    const TaylorSeries x = random_series(random, -1.2, 1.2), y = random_series(random, 0.6, 2);
    expect_same(y / y, 1, 1e-11, "y / y");
    expect_same(sqrt(y) * sqrt(y), y, 1e-11, "sqrt");
    expect_same(exp(log(y)), y, 1e-11, "exp log");
    expect_same(exp(x) * exp(-x), 1, 1e-11, "exp");
    expect_same(sin(x) * sin(x) + cos(x) * cos(x), 1, 1e-11, "sin cos");
    expect_same(sin(2 * x), 2 * sin(x) * cos(x), 1e-11, "sin 2x");
    expect_same(tan(x) * cos(x), sin(x), 1e-10, "tan");
    expect_same(atan(tan(x)), x, 1e-9, "atan");
    expect_same(cosh(x) * cosh(x) - sinh(x) * sinh(x), 1, 1e-11, "cosh sinh");
    expect_same(sinh(x) + cosh(x), exp(x), 1e-11, "sinh + cosh");
    expect_same(tanh(x) * cosh(x), sinh(x), 1e-11, "tanh");
    expect_same(asin(sin(x)), x, 1e-8, "asin");
    expect_same(acos(cos(y)), y, 1e-8, "acos");
    expect_same(pow(y, 2.5) * pow(y, 2.5), y * y * y * y * y, 1e-9, "pow 2.5");
    expect_same(pow(pow(y, 0.1), 10), y, 1e-9, "pow 0.1");
    expect_same(pow(x, 3), x * x * x, 1e-11, "pow 3");
    expect_same(pow(y, -2) * y * y, 1, 1e-11, "pow -2");
    expect_same(pow(y, x), exp(x * log(y)), 1e-11, "pow x");
    expect_same(abs(-y), y, 0, "abs");
  }
}

TEST(Taylor, DerivativesAreThoseOfDifferences) {
  // In long double, by fourth-order central differences with steps of 1e-3.
  const auto f = [](auto u, auto v) {
    using std::atan, std::cos, std::exp, std::sqrt;
    return exp(-(u * u)) * cos(3 * u * v) / sqrt(2 + v) + atan(u - 2 * v);
  };
  const long double h = 1e-3L;
  const auto first = [&](auto&& g) { return (8 * (g(h) - g(-h)) - (g(2 * h) - g(-2 * h))) / (12 * h); };
  Random random(4);
  for (int k = 0; k < 50; ++k) {
    const double u = uniform(random, -1, 1), v = uniform(random, -1, 1);
    const TaylorSeries s = f(TaylorSeries::variable(u, 0), TaylorSeries::variable(v, 1));
    const auto value = [&](long double a, long double b) { return f(u + a, v + b); };
    const auto du = [&](long double b) { return first([&](long double a) { return value(a, b); }); };
    EXPECT_NEAR(s.value(), double(value(0, 0)), 1e-15);
    EXPECT_NEAR(s.derivative(1, 0), double(du(0)), 1e-8);
    EXPECT_NEAR(s.derivative(0, 1), double(first([&](long double b) { return value(0, b); })), 1e-8);
    EXPECT_NEAR(s.derivative(1, 1), double(first(du)), 1e-7);
  }
}

TEST(Taylor, ValuesStayWhereDerivativesAreInfinite) {
  const auto root = sqrt(TaylorSeries::variable(0, 0));
  EXPECT_EQ(root.value(), 0);
  EXPECT_FALSE(std::isfinite(root.derivative(1, 0)));
  EXPECT_EQ(sqrt(TaylorSeries(0)).derivative(1, 0), 0);  // a constant has derivatives everywhere
  const auto power = pow(TaylorSeries::variable(0, 0), 1.5);
  EXPECT_EQ(power.derivative(1, 0), 0);
  EXPECT_FALSE(std::isfinite(power.derivative(2, 0)));
  const auto corner = abs(TaylorSeries::variable(0, 1));
  EXPECT_EQ(corner.value(), 0);
  EXPECT_TRUE(std::isnan(corner.derivative(0, 1)));
}

TEST(Taylor, BoundsHoldTheSeriesWithin) {
  using Bound = Taylor<IntervalNumber, 5>;
  const std::function<Bound(Bound, Bound)> bounds[] = {
      [](Bound u, Bound v) { return exp(-(u * u)) * cos(3 * u * v) / sqrt(2 + v); },
      [](Bound u, Bound v) { return atan(u - 2 * v) + asin(u * v / 2) - tan(u / 2) * log(2 + v); },
      [](Bound u, Bound v) {
        return pow(2 + u, 1.5) * sinh(v) + pow(0.91 + u, 0.3) - cosh(u) * tanh(v) + acos(v / 2) * pow(u, 4);
      },
      [](Bound u, Bound v) { return sin(u + v) / (3 + u * u) - abs(2 + u) * pow(1.5 + v, -3); }};
  const std::function<RealSeries(RealSeries, RealSeries)> series[] = {
      [](RealSeries u, RealSeries v) { return exp(-(u * u)) * cos(3 * u * v) / sqrt(2 + v); },
      [](RealSeries u, RealSeries v) { return atan(u - 2 * v) + asin(u * v / 2) - tan(u / 2) * log(2 + v); },
      [](RealSeries u, RealSeries v) {
        return pow(2 + u, 1.5) * sinh(v) + pow(0.91 + u, 0.3) - cosh(u) * tanh(v) + acos(v / 2) * pow(u, 4);
      },
      [](RealSeries u, RealSeries v) { return sin(u + v) / (3 + u * u) - abs(2 + u) * pow(1.5 + v, -3); }};
  Random random(5);
  for (std::size_t f = 0; f < std::size(bounds); ++f)
    for (int k = 0; k < 100; ++k) {
      const double u = uniform(random, -0.9, 0.5), v = uniform(random, -0.9, 0.5);
      const double width = std::pow(10.0, uniform(random, -14, -0.5));
      const Bound bound = bounds[f](Bound::variable({u, u + width}, 0), Bound::variable({v, v + width}, 1));
      for (int n = 0; n < 4; ++n) {
        const double a = std::min(u + width, u + uniform(random, 0, 1) * width), b = n == 0 ? v : v + width;
        const RealSeries within = series[f](RealSeries::variable(a, 0), RealSeries::variable(b, 1));
        for (int i = 0; i <= 5; ++i)
          for (int j = 0; i + j <= 5; ++j) {
            const IntervalNumber c = bound.coefficient(i, j);
            ASSERT_TRUE(c.lower() <= within.coefficient(i, j) && within.coefficient(i, j) <= c.upper())
                << f << ": " << i << " " << j << ", width " << width;
          }
      }
    }
}

TEST(Taylor, BoundsInOneVariableAreThoseOfTwo) {
  using One = Taylor<IntervalNumber, 8, 1>;
  using Two = Taylor<IntervalNumber, 8>;
  const auto f = [](const auto& u, const auto& v) { return sqrt(3 + u * v) * sin(u); };
  const IntervalNumber u(0.25, 0.5), v(1, 1.5);
  const One one = f(One::variable(u), One(v));
  const Two two = f(Two::variable(u, 0), Two(v));
  for (int k = 0; k <= 8; ++k) {
    EXPECT_NEAR(one.derivative(k).lower(), two.derivative(k, 0).lower(), 1e-9 * two.derivative(k, 0).magnitude());
    EXPECT_NEAR(one.derivative(k).upper(), two.derivative(k, 0).upper(), 1e-9 * two.derivative(k, 0).magnitude());
  }
}

}}  // namespace tessera::test
