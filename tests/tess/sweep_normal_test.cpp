// The net of a sweep's normal has low degrees, points along the normal, and says so of rounded sweeps too.

#include <algorithm>
#include <cmath>
#include <vector>

#include "basis/bernstein.h"
#include "support/random_patches.h"
#include "tess/bounds/sweep_normal.h"

namespace tessera::test { namespace {

/// The curves of a patch p(v) + s(v) q(u): control points and weights.
struct SweptCurves {
  std::vector<Vec3> profile, path;
  std::vector<double> weights_u, weights_v, scales;
};

SweptCurves random_curves(Random& random, int m, int n) {
  SweptCurves of;
  const auto point = [&] { return Vec3{uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1)}; };
  const bool is_rational_u = random() % 2 != 0, is_rational_v = random() % 2 != 0, is_even = random() % 3 == 0;
  for (int i = 0; i <= m; ++i)
    of.profile.push_back(point()), of.weights_u.push_back(is_rational_u ? uniform(random, 0.5, 2) : 1);
  for (int j = 0; j <= n; ++j) {
    of.path.push_back(3.0 * point()), of.weights_v.push_back(is_rational_v ? uniform(random, 0.5, 2) : 1);
    of.scales.push_back(is_even ? 1 : uniform(random, 0.5, 2));
  }
  return of;
}

/// `is_turned`: u and v are exchanged. Points are moved by up to `noise`, and all by `away`.
BezierPatch swept(const SweptCurves& of, bool is_turned, Random& random, double noise = 0, const Vec3& away = {}) {
  const std::size_t m = of.profile.size() - 1, n = of.path.size() - 1;
  std::vector<Vec3> points;
  std::vector<double> weights;
  for (std::size_t a = 0; a <= (is_turned ? n : m); ++a)
    for (std::size_t b = 0; b <= (is_turned ? m : n); ++b) {
      const std::size_t i = is_turned ? b : a, j = is_turned ? a : b;
      const auto moved = [&] { return noise * uniform(random, -1, 1); };
      const Vec3 by = noise > 0 ? Vec3{moved(), moved(), moved()} : Vec3{};
      points.push_back(away + of.path[j] + of.scales[j] * of.profile[i] + by);
      weights.push_back(of.weights_u[i] * of.weights_v[j]);
    }
  const int rows = static_cast<int>(is_turned ? n : m), columns = static_cast<int>(is_turned ? m : n);
  return *BezierPatch::rational(rows, columns, points, weights);
}

Vec3 value_of_net(const VectorNet& net, double u, double v) {
  std::vector<double> in_u(static_cast<std::size_t>(net.degree_u + 1)),
      in_v(static_cast<std::size_t>(net.degree_v + 1));
  bernstein_values(net.degree_u, u, in_u.data());
  bernstein_values(net.degree_v, v, in_v.data());
  Vec3 sum;
  for (int i = 0; i <= net.degree_u; ++i)
    for (int j = 0; j <= net.degree_v; ++j)
      sum += in_u[static_cast<std::size_t>(i)] * in_v[static_cast<std::size_t>(j)] * net(i, j);
  return sum;
}

/// The largest sine of the angle between the field and the normal, times the field's length, over its rounding.
double largest_error(const BezierPatch& patch, const NormalNet& net, Random& random) {
  double most = 0;
  for (int sample = 0; sample < 20; ++sample) {
    const double u = uniform(random, 0, 1), v = uniform(random, 0.01, 1);
    const SurfaceJet jet = evaluate_jet(patch, u, v);
    const Vec3 normal = cross(jet.du, jet.dv), field = value_of_net(net.net, u, v);
    if (!(length(normal) > 1e-4 * length(jet.du) * length(jet.dv))) continue;  // rounding of the jet decides
    EXPECT_GT(dot(normal, field), 0);
    most = std::max(most, length(cross(normalized(normal), field)) / net.rounding);
  }
  return most;
}

TEST(SweepNormal, HasLowDegreesAndPointsAlongTheNormal) {
  Random random(11);
  for (int kind = 0; kind < 200; ++kind) {
    const int m = 1 + static_cast<int>(random() % 4), n = 1 + static_cast<int>(random() % 4);
    const bool is_turned = kind % 2 != 0;
    const BezierPatch patch = swept(random_curves(random, m, n), is_turned, random);
    const auto net = sweep_normal_net(patch);
    ASSERT_TRUE(net) << kind;
    const int p = is_turned ? net->net.degree_v : net->net.degree_u,
              q = is_turned ? net->net.degree_u : net->net.degree_v;
    EXPECT_LE(std::min(p, q), 2 * std::max(m, n) - 2) << kind;
    EXPECT_LE(p + q, 2 * (m + n) - 4 + (m == 1) + (n == 1)) << kind;
    EXPECT_LE(largest_error(patch, *net, random), 1) << kind;
  }
}

TEST(SweepNormal, ItsRoundingHoldsThatOfPoints) {
  Random random(12);
  for (int kind = 0; kind < 100; ++kind) {
    const int m = 1 + static_cast<int>(random() % 3), n = 1 + static_cast<int>(random() % 3);
    const SweptCurves curves = random_curves(random, m, n);
    const BezierPatch moved = swept(curves, kind % 2 != 0, random, 1e-11);
    const auto net = sweep_normal_net(moved);
    if (net) {
      EXPECT_LE(largest_error(moved, *net, random), 1) << kind;
    }
    const BezierPatch far = swept(curves, kind % 2 != 0, random, 0, {3e4, -2e4, 1e4});
    const auto far_net = sweep_normal_net(far);
    if (far_net) {
      EXPECT_LE(largest_error(far, *far_net, random), 1) << kind;
    }
    EXPECT_TRUE(net || far_net || m * n == 1) << kind;
  }
}

TEST(SweepNormal, PolesAreDividedOut) {
  Random random(13);
  for (int kind = 0; kind < 50; ++kind) {
    const int n = 2 + static_cast<int>(random() % 3);
    SweptCurves curves = random_curves(random, 2, n);
    curves.scales.front() = 0;
    const BezierPatch patch = swept(curves, false, random);
    ASSERT_TRUE(patch.collapsed_sides().has(Side::v0));
    const auto net = sweep_normal_net(patch);
    ASSERT_TRUE(net) << kind;
    EXPECT_LE(largest_error(patch, *net, random), 1) << kind;
  }
}

TEST(SweepNormal, OtherPatchesHaveNone) {
  Random random(14);
  for (int kind = 0; kind < 50; ++kind) {
    const int m = 2 + static_cast<int>(random() % 3), n = 2 + static_cast<int>(random() % 3);
    EXPECT_FALSE(sweep_normal_net(random_rational(random, m, n, 0.3, 3))) << kind;
    EXPECT_FALSE(sweep_normal_net(random_polynomial(random, m, n))) << kind;
    const SweptCurves curves = random_curves(random, m, n);
    EXPECT_FALSE(sweep_normal_net(swept(curves, false, random, 1e-6))) << kind;
    SweptCurves crossed = curves;  // its profile shrinks to a point within, where the normal turns around
    crossed.scales.front() = -crossed.scales.front();
    EXPECT_FALSE(sweep_normal_net(swept(crossed, false, random))) << kind;
  }
}

}}  // namespace tessera::test
