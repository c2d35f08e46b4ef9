#include "basis/bernstein_net.h"

#include "support/random_patches.h"

namespace tessera::test { namespace {

BernsteinNet<double> random_net(Random& random, int m, int n) {
  BernsteinNet<double> net(m, n);
  for (double& x : net.values) x = uniform(random, -1, 1);
  return net;
}
double value(const BernsteinNet<double>& net, double u, double v) {
  std::vector<double> a(static_cast<std::size_t>(net.degree_u) + 1), b(static_cast<std::size_t>(net.degree_v) + 1);
  bernstein_values(net.degree_u, u, a.data());
  bernstein_values(net.degree_v, v, b.data());
  double sum = 0;
  for (int i = 0; i <= net.degree_u; ++i)
    for (int j = 0; j <= net.degree_v; ++j)
      sum += a[static_cast<std::size_t>(i)] * b[static_cast<std::size_t>(j)] * net.at(i, j);
  return sum;
}

TEST(BernsteinNet, ArithmeticIsThatOfTheValues) {
  Random random(1);
  for (int m = 0; m <= 15; m += 3)
    for (int n = 0; n <= 15; n += 5) {
      const BernsteinNet<double> a = random_net(random, m, n), b = random_net(random, n, m);
      const auto times = a * b, difference = a - b, higher = elevated(a, m + 3, n + 20);
      EXPECT_EQ(times.degree_u, m + n);
      EXPECT_EQ(higher.degree_v, n + 20);
      for (int k = 0; k < 5; ++k) {
        const double u = uniform(random, 0, 1), v = uniform(random, 0, 1);
        EXPECT_NEAR(value(times, u, v), value(a, u, v) * value(b, u, v), 1e-14);
        EXPECT_NEAR(value(difference, u, v), value(a, u, v) - value(b, u, v), 1e-14);
        EXPECT_NEAR(value(higher, u, v), value(a, u, v), 1e-14);
      }
    }
}

TEST(BernsteinNet, DerivativesOfProductsObeyTheProductRule) {
  Random random(2);
  const BernsteinNet<double> a = random_net(random, 4, 3), b = random_net(random, 2, 5);
  const auto left = derivative_u(a * b), one = derivative_u(a) * b, other = a * derivative_u(b);
  const auto left_v = derivative_v(a * b), one_v = derivative_v(a) * b, other_v = a * derivative_v(b);
  for (int k = 0; k < 10; ++k) {
    const double u = uniform(random, 0, 1), v = uniform(random, 0, 1);
    EXPECT_NEAR(value(left, u, v), value(one, u, v) + value(other, u, v), 1e-13);
    EXPECT_NEAR(value(left_v, u, v), value(one_v, u, v) + value(other_v, u, v), 1e-13);
  }
  EXPECT_EQ(derivative_u(bernstein_one(0, 2)).values, std::vector<double>(3));
  EXPECT_EQ(derivative_v(bernstein_one(2, 0)).values, std::vector<double>(3));
}

TEST(BernsteinNet, HalvesAreTheCurve) {
  Random random(3);
  for (int m = 0; m <= 60; m += 6) {
    const BernsteinNet<double> curve = random_net(random, m, 0);
    const auto [left, right] = halves(curve);
    for (const double t : {0.0, 0.3, 1.0}) {
      EXPECT_NEAR(value(left, t, 0), value(curve, t / 2, 0), 1e-14);
      EXPECT_NEAR(value(right, t, 0), value(curve, 0.5 + t / 2, 0), 1e-14);
    }
    EXPECT_EQ(left.values.back(), right.values.front());
  }
}

}}  // namespace tessera::test
