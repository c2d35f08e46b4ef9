// Checks the reference evaluators against an independent one in long double, and by the properties of Bezier patches.

#include <limits>

#include "support/random_patches.h"
#include "support/reference.h"
#include "support/ulp.h"

namespace tessera::test { namespace {

using Evaluator = Vec3 (*)(const BezierPatch&, double, double);
constexpr Evaluator evaluators[] = {
    de_casteljau, de_casteljau_bilinear, de_casteljau_rational,
    [](const BezierPatch& p, double u, double v) { return evaluate_jet(p, u, v).position; }};

/// Calls body(patch, u, v) with patches of every degree, polynomial and rational, at random parameters.
template <class Body>
void for_every_degree(std::uint64_t seed, Body body) {
  Random random(seed);
  for (int m = 1; m <= max_degree; ++m)
    for (int n = 1; n <= max_degree; ++n)
      for (const BezierPatch& patch : {random_polynomial(random, m, n), random_rational(random, m, n)})
        for (int k = 0; k < 3; ++k) {
          const double u = uniform(random, 0, 1), v = uniform(random, 0, 1);
          body(patch, u, v);
          if (::testing::Test::HasFailure()) FAIL() << "degree (" << m << ", " << n << ") at " << u << ", " << v;
        }
}

TEST(Evaluators, AgreeWithTheDefinition) {
  for_every_degree(1, [](const BezierPatch& patch, double u, double v) {
    const double unit = double_unit * largest_coefficient(patch);
    const Vec3 expected = reference_position(patch, u, v);
    for (const Evaluator evaluate : evaluators)
      EXPECT_TRUE(within_units(evaluate(patch, u, v), expected, unit, patch.is_rational() ? 8 : 6));
  });
}

TEST(Evaluators, JetsAgreeWithTheDefinition) {
  for_every_degree(2, [](const BezierPatch& patch, double u, double v) {
    const SurfaceJet jet = evaluate_jet(patch, u, v);
    const RealJet expected = reference_jet(patch, u, v);
    const int m = patch.degree_u(), n = patch.degree_v();
    // Weights of 1/4 to 4 make derivatives of ratios up to 16 times larger, for each order.
    const double unit = double_unit * largest_coefficient(patch), growth = patch.is_rational() ? 4 : 1;
    EXPECT_TRUE(within_units(jet.du, expected.du.rounded(), unit, 8 * growth * m));
    EXPECT_TRUE(within_units(jet.dv, expected.dv.rounded(), unit, 8 * growth * n));
    EXPECT_TRUE(within_units(jet.duu, expected.duu.rounded(), unit, 8 * growth * growth * m * m));
    EXPECT_TRUE(within_units(jet.duv, expected.duv.rounded(), unit, 8 * growth * growth * m * n));
    EXPECT_TRUE(within_units(jet.dvv, expected.dvv.rounded(), unit, 8 * growth * growth * n * n));
  });
}

TEST(Evaluators, WorkOutsideTheUnitSquare) {
  Random random(3);
  const BezierPatch patch = random_polynomial(random, 3, 2);
  for (const auto& [u, v] : {std::pair{-0.5, 0.5}, {1.5, -0.25}, {2.0, 2.0}}) {
    const Vec3 expected = reference_position(patch, u, v);
    for (const Evaluator evaluate : evaluators) EXPECT_LT(max_abs(evaluate(patch, u, v) - expected), 1e-13);
  }
}

TEST(Evaluators, InterpolateTheCorners) {
  for_every_degree(4, [](const BezierPatch& patch, double, double) {
    const int m = patch.degree_u(), n = patch.degree_v();
    const double unit = double_unit * largest_coefficient(patch);
    for (const int a : {0, 1})
      for (const int b : {0, 1}) {
        const Vec3& corner = patch.point(a * m, b * n);
        EXPECT_EQ(evaluate_jet(patch, a, b).position, corner);
        EXPECT_EQ(de_casteljau_rational(patch, a, b), corner);
        // Homogeneous evaluators multiply by the weight and divide by it.
        const double limit = patch.is_rational() ? 1 : 0;
        EXPECT_TRUE(within_units(de_casteljau(patch, a, b), corner, unit, limit));
        EXPECT_TRUE(within_units(de_casteljau_bilinear(patch, a, b), corner, unit, limit));
      }
  });
}

TEST(Evaluators, BordersDependOnTheBorderNetAlone) {
  Random random(5);
  for (const auto& [m, n] : {std::pair{3, 3}, {1, 4}, {5, 2}, {7, 7}}) {
    std::vector<Vec3> points = random_points(random, m, n);
    const std::vector<double> weights = random_weights(random, m, n, 0.5, 2);
    const BezierPatch before = rational(m, n, points, weights);
    for (int i = 1; i < m; ++i)
      for (int j = 1; j < n; ++j) points[static_cast<std::size_t>(i * (n + 1) + j)] = uniform_vector(random, -1, 1);
    const BezierPatch after = rational(m, n, points, weights);
    for (int k = 0; k <= 16; ++k)
      for (const double end : {0.0, 1.0})
        for (const Evaluator evaluate : evaluators) {
          EXPECT_EQ(evaluate(before, k / 16.0, end), evaluate(after, k / 16.0, end));
          EXPECT_EQ(evaluate(before, end, k / 16.0), evaluate(after, end, k / 16.0));
        }
  }
}

TEST(Evaluators, StayInTheHull) {
  for_every_degree(6, [](const BezierPatch& patch, double u, double v) {
    Random random(7);
    const double slack = 8 * double_unit * largest_coefficient(patch);
    for (const Evaluator evaluate : evaluators) {
      const Vec3 p = evaluate(patch, u, v);
      for (int k = 0; k < 8; ++k) {
        const Vec3 direction = uniform_vector(random, -1, 1);
        double furthest = -std::numeric_limits<double>::infinity();
        for (const Vec3& q : patch.points()) furthest = std::max(furthest, dot(direction, q));
        EXPECT_LE(dot(direction, p), furthest + slack);
      }
    }
  });
}

TEST(Evaluators, AreAffinelyInvariant) {
  const Vec3 column[] = {{2, 0.5, -1}, {0.25, -1, 3}, {1, 1, 0.5}}, shift{3, -7, 11};
  const auto linear = [&](const Vec3& p) { return p.x * column[0] + p.y * column[1] + p.z * column[2]; };
  for_every_degree(8, [&](const BezierPatch& patch, double u, double v) {
    std::vector<Vec3> points;
    std::vector<double> weights;
    for (std::size_t k = 0; k < patch.points().size(); ++k) {
      points.push_back(linear(patch.points()[k]) + shift);
      weights.push_back(patch.is_rational() ? patch.weights()[k] : 1);
    }
    const BezierPatch image = rational(patch.degree_u(), patch.degree_v(), points, weights);
    const double unit = double_unit * largest_coefficient(image);
    for (const Evaluator evaluate : evaluators)
      EXPECT_TRUE(within_units(evaluate(image, u, v), linear(evaluate(patch, u, v)) + shift, unit, 12));
    const int degree = std::max(patch.degree_u(), patch.degree_v());
    EXPECT_TRUE(within_units(evaluate_jet(image, u, v).du, linear(evaluate_jet(patch, u, v).du), unit, 64 * degree));
    EXPECT_TRUE(within_units(evaluate_jet(image, u, v).dv, linear(evaluate_jet(patch, u, v).dv), unit, 64 * degree));
  });
}

TEST(Evaluators, DerivativesLoseNothingFarFromZero) {
  Random random(9);
  for (const bool with_weights : {false, true}) {
    std::vector<Vec3> near, far;
    for (int k = 0; k < 16; ++k) {  // multiples of 1/1024, so that the shift is exact
      const Vec3 p = uniform_vector(random, -1024, 1024);
      near.push_back((1.0 / 1024) * Vec3{std::floor(p.x), std::floor(p.y), std::floor(p.z)});
      far.push_back(near.back() + Vec3{1e6, -2e9, 3e5});
    }
    const std::vector<double> weights =
        with_weights ? random_weights(random, 3, 3, 0.5, 2) : std::vector<double>(16, 1);
    const BezierPatch here = rational(3, 3, near, weights), there = rational(3, 3, far, weights);
    for (int k = 0; k < 100; ++k) {
      const double u = uniform(random, 0, 1), v = uniform(random, 0, 1);
      const SurfaceJet a = evaluate_jet(here, u, v), b = evaluate_jet(there, u, v);
      EXPECT_EQ(a.du, b.du);
      EXPECT_EQ(a.dv, b.dv);
      EXPECT_EQ(a.duu, b.duu);
      EXPECT_EQ(a.duv, b.duv);
      EXPECT_EQ(a.dvv, b.dvv);
    }
  }
}

TEST(Evaluators, CornerDerivatives) {
  Random random(10);
  const BezierPatch bicubic = random_polynomial(random, 3, 3);
  const auto v = [&](int i, int j) { return bicubic.point(i, j); };
  const SurfaceJet corner = evaluate_jet(bicubic, 0, 0);
  const double unit = double_unit * largest_coefficient(bicubic);
  EXPECT_TRUE(within_units(corner.du, 3 * (v(1, 0) - v(0, 0)), unit, 8));
  EXPECT_TRUE(within_units(corner.dv, 3 * (v(0, 1) - v(0, 0)), unit, 8));
  EXPECT_TRUE(within_units(corner.duu, 6 * (v(2, 0) - 2 * v(1, 0) + v(0, 0)), unit, 32));
  EXPECT_TRUE(within_units(corner.duv, 9 * (v(1, 1) - v(1, 0) - v(0, 1) + v(0, 0)), unit, 64));
  EXPECT_TRUE(within_units(evaluate_jet(bicubic, 1, 1).du, 3 * (v(3, 3) - v(2, 3)), unit, 8));

  // At a rational corner r_u = m w_10 / w_00 (V_10 - V_00) (Farin, eq. 13.10).
  const BezierPatch patch = random_rational(random, 5, 2);
  const Vec3 du = (5 * patch.weight(1, 0) / patch.weight(0, 0)) * (patch.point(1, 0) - patch.point(0, 0));
  EXPECT_TRUE(within_units(evaluate_jet(patch, 0, 0).du, du, double_unit * max_abs(du), 8));
}

TEST(Evaluators, DerivativesArePatchesOnDifferenceNets) {
  Random random(11);
  const int m = 4, n = 3;
  const BezierPatch patch = random_polynomial(random, m, n);
  std::vector<Vec3> along_u, mixed;
  for (int i = 0; i < m; ++i)
    for (int j = 0; j <= n; ++j) {
      along_u.push_back(m * (patch.point(i + 1, j) - patch.point(i, j)));
      if (j < n)
        mixed.push_back(
            m * n *
            ((patch.point(i + 1, j + 1) - patch.point(i + 1, j)) - (patch.point(i, j + 1) - patch.point(i, j))));
    }
  const BezierPatch du = polynomial(m - 1, n, along_u), duv = polynomial(m - 1, n - 1, mixed);
  for (int k = 0; k < 50; ++k) {
    const double u = uniform(random, 0, 1), v = uniform(random, 0, 1);
    EXPECT_TRUE(within_units(evaluate_jet(patch, u, v).du, de_casteljau(du, u, v), double_unit, 64));
    EXPECT_TRUE(within_units(evaluate_jet(patch, u, v).duv, de_casteljau(duv, u, v), double_unit, 256));
  }
}

TEST(Evaluators, ExchangingTheParametersExchangesTheDerivatives) {
  for_every_degree(12, [](const BezierPatch& patch, double u, double v) {
    const SurfaceJet a = evaluate_jet(patch, u, v), b = evaluate_jet(transposed(patch), v, u);
    const int degree = std::max(patch.degree_u(), patch.degree_v());
    EXPECT_LT(max_abs(a.position - b.position), 16 * double_unit);
    EXPECT_LT(max_abs(a.du - b.dv), 64 * degree * double_unit);
    EXPECT_LT(max_abs(a.duu - b.dvv), 512 * degree * degree * double_unit);
    EXPECT_LT(max_abs(a.duv - b.duv), 512 * degree * degree * double_unit);
  });
}

bool has_nan(const Vec3& p) { return p.x != p.x || p.y != p.y || p.z != p.z; }

TEST(Evaluators, FiniteInputGivesNoNaN) {
  Random random(13);
  for (const double size : {1e308, 1e150, 1e-150, 1e-300, 5e-324, 0.0})
    for (const double lightest : {1.0, 1e-30, 1e-99})
      for (const double heaviest : {1.0, 1e300, 1e-200}) {
        std::vector<Vec3> points = random_points(random, 3, 2, {}, size);
        std::vector<double> weights = random_weights(random, 3, 2, 0.5, 1);
        for (std::size_t k = 0; k < weights.size(); ++k) weights[k] *= heaviest * (k % 3 == 1 ? lightest : 1);
        const BezierPatch patch = rational(3, 2, points, weights);
        for (const double u : {0.0, 5e-324, 1e-300, 1e-17, 0.5, 1 - 0x1p-53, 1.0})
          for (const double v : {0.0, 5e-324, 1e-160, 0.3, 1 - 0x1p-53, 1.0}) {
            for (const Evaluator evaluate : evaluators) {
              const Vec3 p = evaluate(patch, u, v);
              EXPECT_TRUE(is_finite(p) && max_abs(p) <= 1.0001 * size)
                  << size << " " << heaviest << " " << u << " " << v;
            }
            const SurfaceJet jet = evaluate_jet(patch, u, v);
            for (const Vec3& d : {jet.du, jet.dv, jet.duu, jet.duv, jet.dvv}) EXPECT_FALSE(has_nan(d)) << size;
            EXPECT_TRUE(is_finite(unit_normal(patch, u, v).direction));
          }
      }
}

}}  // namespace tessera::test
