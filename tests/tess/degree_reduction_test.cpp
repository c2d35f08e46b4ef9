// Nets of lower degrees: exact where that is possible, else as far off as stated; and bounds on turning that use them.

#include "tess/bounds/degree_reduction.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "basis/bernstein.h"
#include "tess/bounds/turning_bound.h"
#include "tess/tessellate_support.h"

namespace tessera::test { namespace {

double value_of(const std::vector<double>& net, int m, int n, double u, double v) {
  std::vector<double> along_u(static_cast<std::size_t>(m) + 1), along_v(static_cast<std::size_t>(n) + 1);
  bernstein_values(m, u, along_u.data());
  bernstein_values(n, v, along_v.data());
  double sum = 0;
  for (std::size_t i = 0; i < along_u.size(); ++i)
    for (std::size_t j = 0; j < along_v.size(); ++j) sum += along_u[i] * along_v[j] * net[i * along_v.size() + j];
  return sum;
}

/// Coefficients that vary smoothly, so that polynomials of lower degrees follow them nearly.
std::vector<double> smooth_net(int m, int n) {
  std::vector<double> net;
  for (int i = 0; i <= m; ++i)
    for (int j = 0; j <= n; ++j)
      net.push_back(std::sin(1.3 * i / m + 0.2) * std::exp(0.7 * j / n) + 0.1 * i * j / (m * n));
  return net;
}

TEST(DegreeReduction, StatesHowFarOffItIs) {
  struct Case {
    int m, n, lower_m, lower_n;
  };
  for (const Case& of : {Case{16, 26, 9, 14}, {12, 12, 7, 7}, {44, 44, 23, 23}, {5, 20, 5, 11}, {3, 40, 3, 2}}) {
    const DegreeReduction u(of.m, of.lower_m), v(of.n, of.lower_n);
    const std::vector<double> net = smooth_net(of.m, of.n);
    std::vector<double> lower(static_cast<std::size_t>((of.lower_m + 1) * (of.lower_n + 1))), room(2 * net.size());
    const double bound = NetReduction(u, v).apply(net.data(), lower.data(), room.data());
    double most = 0;
    for (int k = 0; k <= 400; ++k) {
      const double a = k % 21 / 20.0, b = k / 21 / 19.0;
      most = std::max(most, std::abs(value_of(net, of.m, of.n, a, b) - value_of(lower, of.lower_m, of.lower_n, a, b)));
    }
    EXPECT_LE(most, bound) << of.m << " " << of.n;
    EXPECT_LE(bound, of.lower_n > 2 ? 1e-4 : 1) << of.m << " " << of.n;
  }
}

/// Returns the coefficients of degree m + 1 along u.
std::vector<double> raised(const std::vector<double>& net, int m, int n) {
  const auto row = static_cast<std::size_t>(n) + 1;
  std::vector<double> next(net.size() + row);
  for (std::size_t k = 0; k < next.size(); ++k) {
    const double share = static_cast<double>(k / row) / (m + 1);
    next[k] = (k >= row ? share * net[k - row] : 0) + (k < net.size() ? (1 - share) * net[k] : 0);
  }
  return next;
}

TEST(DegreeReduction, GivesLowerPolynomialsBack) {
  Random random(4);
  std::vector<double> low(10 * 6);
  for (double& number : low) number = uniform(random, -1, 1);
  std::vector<double> net = low;
  for (int m = 9; m < 16; ++m) net = raised(net, m, 5);
  const DegreeReduction u(16, 9), v(5, 5);
  std::vector<double> lower(low.size()), room(2 * net.size());
  EXPECT_LE(NetReduction(u, v).apply(net.data(), lower.data(), room.data()), 1e-11);
  for (std::size_t k = 0; k < low.size(); ++k) EXPECT_NEAR(lower[k], low[k], 1e-9) << k;
}

/// A patch that is bent at random, but a graph over the plane.
BezierPatch bent_patch(Random& random, int m, int n, bool is_rational) {
  std::vector<Vec3> points;
  std::vector<double> weights;
  for (int i = 0; i <= m; ++i)
    for (int j = 0; j <= n; ++j) {
      points.push_back({1.0 * i / m, 1.0 * j / n, uniform(random, -0.2, 0.2)});
      weights.push_back(uniform(random, 0.9, 1.1));
    }
  return is_rational ? good(BezierPatch::rational(m, n, points, weights)) : good(BezierPatch::polynomial(m, n, points));
}

/// The fields of these patches' normals have up to 29 x 29 control points, which are made fewer.
TEST(DegreeReduction, LeavesBoundsOnTurningProven) {
  Random random(8);
  int bounded = 0;
  for (int kind = 0; kind < 24; ++kind) {
    const int m = 6 + kind % 5, n = 9 - kind % 3;
    const BezierPatch patch = bent_patch(random, m, n, kind % 2 == 1);
    const TurningBound bound(patch, 0.3);
    if (!bound.is_finite()) continue;
    ++bounded;
    for (int sample = 0; sample < 400; ++sample) {
      const double u = uniform(random, 0.01, 0.99), v = uniform(random, 0.01, 0.99), step = 1e-5;
      const auto normal = [&](double a, double b) {
        const SurfaceJet jet = evaluate_jet(patch, a, b);
        return normalized(cross(jet.du, jet.dv));
      };
      const auto i = static_cast<int>(8 * u), j = static_cast<int>(8 * v);
      const double turning_u = length(normal(u + step, v) - normal(u - step, v)) / (2 * step),
                   turning_v = length(normal(u, v + step) - normal(u, v - step)) / (2 * step);
      if (static_cast<int>(8 * (u + step)) != static_cast<int>(8 * (u - step))) continue;
      if (static_cast<int>(8 * (v + step)) != static_cast<int>(8 * (v - step))) continue;
      EXPECT_LE(turning_u, double(bound.u(i, j)) * (1 + 1e-6) + 1e-5) << kind;
      EXPECT_LE(turning_v, double(bound.v(i, j)) * (1 + 1e-6) + 1e-5) << kind;
    }
  }
  EXPECT_GE(bounded, 6);
}

}}  // namespace tessera::test
