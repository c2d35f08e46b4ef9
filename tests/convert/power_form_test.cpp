#include "convert/basis/power_form.h"

#include "support/random_patches.h"
#include "support/reference.h"

namespace tessera::test { namespace {

/// M in B_{k,n}(t) = sum_i M_ik t^i.
Real matrix_entry(int n, int i, int k) {
  const auto choose = [](int a, int b) {
    Real value = 1;
    for (int j = 1; j <= b; ++j) value = value * (a - b + j) / j;
    return value;
  };
  return k > i ? 0 : ((i - k) % 2 ? -1 : 1) * choose(n, i) * choose(i, k);
}

std::vector<double> random_net(Random& random, std::size_t size, bool integers) {
  std::vector<double> net(size);
  for (double& x : net) x = integers ? std::floor(uniform(random, -100, 100)) : uniform(random, -1, 1);
  return net;
}

/// Compares with M_u G M_v^T in long double; `unit` = 0 demands equality.
void expect_matrix_product(int m, int n, int components, const std::vector<double>& net, double unit) {
  std::vector<double> power = net;
  power_coefficients(m, n, components, power);
  for (int i = 0; i <= m; ++i)
    for (int j = 0; j <= n; ++j)
      for (int c = 0; c < components; ++c) {
        Real sum = 0, size = 0;
        for (int k = 0; k <= i; ++k)
          for (int l = 0; l <= j; ++l) {
            const Real term = matrix_entry(m, i, k) * matrix_entry(n, j, l) *
                              net[static_cast<std::size_t>((k * (n + 1) + l) * components + c)];
            sum += term;
            size += std::abs(term);
          }
        const double value = power[static_cast<std::size_t>((i * (n + 1) + j) * components + c)];
        EXPECT_LE(std::abs(static_cast<double>(value - sum)), unit * (i + j + 2) * static_cast<double>(size))
            << "degree (" << m << ", " << n << ") coefficient [" << i << "][" << j << "]";
      }
}

TEST(PowerForm, EqualsTheMatrixProductOnIntegers) {
  Random random(1);
  for (int m = 1; m <= 7; ++m)
    for (int n = 1; n <= 7; ++n)
      expect_matrix_product(m, n, 3, random_net(random, static_cast<std::size_t>((m + 1) * (n + 1) * 3), true), 0);
}

TEST(PowerForm, EqualsTheMatrixProductWithinRounding) {
  Random random(2);
  for (int m = 1; m <= max_degree; ++m)
    for (int n = 1; n <= max_degree; n += 2)
      expect_matrix_product(m, n, 1, random_net(random, static_cast<std::size_t>((m + 1) * (n + 1)), false), 0x1p-52);
}

TEST(PowerForm, ComponentsDontMix) {
  Random random(3);
  const std::vector<double> net = random_net(random, 4 * 6 * 4, false);
  std::vector<double> together = net;
  power_coefficients(3, 5, 4, together);
  for (std::size_t c = 0; c < 4; ++c) {
    std::vector<double> alone;
    for (std::size_t k = c; k < net.size(); k += 4) alone.push_back(net[k]);
    power_coefficients(3, 5, 1, alone);
    for (std::size_t k = 0; k < alone.size(); ++k) EXPECT_EQ(alone[k], together[4 * k + c]);
  }
}

TEST(PowerForm, IsTheSamePolynomial) {
  Random random(4);
  for (int m = 1; m <= 5; ++m)
    for (int n = 1; n <= 5; ++n) {
      const BezierPatch patch = random_polynomial(random, m, n);
      std::vector<double> net;
      for (const Vec3& p : patch.points()) net.insert(net.end(), {p.x, p.y, p.z});
      power_coefficients(m, n, 3, net);
      const double u = uniform(random, 0, 1), v = uniform(random, 0, 1);
      Vec3 sum;
      for (int i = m; i >= 0; --i) {
        Vec3 row;
        for (int j = n; j >= 0; --j) {
          const double* a = &net[static_cast<std::size_t>((i * (n + 1) + j) * 3)];
          row = v * row + Vec3{a[0], a[1], a[2]};
        }
        sum = u * sum + row;
      }
      EXPECT_LT(max_abs(sum - reference_position(patch, u, v)), 1e-11);
    }
}

}}  // namespace tessera::test
