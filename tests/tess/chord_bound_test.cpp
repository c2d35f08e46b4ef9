// Triangles of any shape within the cells never exceed the certified distance, and it is not far above the true one.

#include "tess/bounds/chord_bound.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/lecture_surfaces.h"
#include "support/random_patches.h"
#include "support/triangle_distance.h"

namespace tessera::test { namespace {

struct Box {
  double u, v, h, k;
};

/// The largest distance found from the patch to triangles in a box: its two halves, and random ones that touch its
/// sides. `samples` points of each triangle.
double found_distance(const BezierPatch& patch, const Box& box, Random& random, int triangles, int samples) {
  double most = 0;
  for (int t = 0; t < triangles; ++t) {
    double s[3][2] = {{0, 0}, {1, 0}, {1, 1}};
    if (t % 4 == 1) s[1][0] = 0, s[1][1] = 1;
    if (t % 4 == 2) s[0][1] = uniform(random, 0, 1), s[2][0] = uniform(random, 0, 1);
    if (t % 4 == 3)
      for (auto& corner : s) corner[0] = uniform(random, 0, 1), corner[1] = uniform(random, 0, 1);
    double u[3], v[3];
    Vec3 corner[3];
    for (int k = 0; k < 3; ++k) {
      u[k] = box.u + box.h * s[k][0];
      v[k] = box.v + box.k * s[k][1];
      corner[k] = de_casteljau(patch, u[k], v[k]);
    }
    for (int sample = 0; sample < samples; ++sample) {
      double a = uniform(random, 0, 1), b = uniform(random, 0, 1);
      if (a + b > 1) a = 1 - a, b = 1 - b;
      if (sample % 3 == 0) b = 0;
      const Vec3 p = de_casteljau(patch, u[0] + a * (u[1] - u[0]) + b * (u[2] - u[0]),
                                  v[0] + a * (v[1] - v[0]) + b * (v[2] - v[0]));
      most = std::max(most, distance_to_triangle(p, corner[0], corner[1], corner[2]));
    }
  }
  return most;
}

/// The largest distance found over some of the cells of `rates`.
double found_distance(const BezierPatch& patch, Rates rates, Random& random) {
  double most = 0;
  for (int cell = 0; cell < 6; ++cell) {
    const double iu = std::floor(uniform(random, 0, rates.u)), iv = std::floor(uniform(random, 0, rates.v));
    most = std::max(most,
                    found_distance(patch, {iu / rates.u, iv / rates.v, 1.0 / rates.u, 1.0 / rates.v}, random, 4, 12));
  }
  return most;
}

BezierPatch random_patch(Random& random, int kind) {
  const int m = 1 + static_cast<int>(random() % 7), n = 1 + static_cast<int>(random() % 7);
  const double size = std::exp(uniform(random, -20, 20));
  const Vec3 centre = (kind % 3 == 0 ? 1e4 : 0) * size * uniform_vector(random, -1, 1);
  if (kind % 2) return random_rational(random, m, n, kind % 4 == 1 ? 0.5 : 0.01, kind % 4 == 1 ? 2 : 100, centre, size);
  return random_polynomial(random, m, n, centre, size);
}

TEST(ChordBound, IsNeverExceeded) {
  Random random(1);
  for (int kind = 0; kind < 1200; ++kind) {
    const BezierPatch patch = random_patch(random, kind);
    const ChordBound plain(patch), bound(patch, true);
    const Rates rates{1 + static_cast<int>(random() % 9), 1 + static_cast<int>(random() % 9)};
    const double rounding = 1e-13 * max_abs(patch.point(0, 0));  // of this test's distances
    ASSERT_LE(bound.distance(rates), plain.distance(rates));
    ASSERT_LE(found_distance(patch, rates, random), bound.distance(rates) + rounding)
        << "kind " << kind << ", rates " << rates.u << " x " << rates.v;
  }
}

/// z = a u^2 + b u v + c v^2, x and y being 2 u and 3 v.
BezierPatch quadric(double a, double b, double c) {
  std::vector<Vec3> points;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      points.push_back({double(i), 1.5 * j, (i == 2 ? a : 0) + b * i * j / 4.0 + (j == 2 ? c : 0)});
  return polynomial(2, 2, points);
}

TEST(ChordBound, KnowsWhichWayPatchesBend) {
  // If the patch bends to one side the errors add up; if to both sides, the larger one counts.
  EXPECT_NEAR(ChordBound(quadric(1, 0, 1), true).distance({1, 1}), 0.5, 1e-6);
  EXPECT_NEAR(ChordBound(quadric(1, 0, -1), true).distance({1, 1}), 0.25, 1e-6);
  EXPECT_NEAR(ChordBound(quadric(1, 0, -1)).distance({1, 1}), 0.5, 1e-6);
  EXPECT_NEAR(ChordBound(quadric(1, 0, -0.2), true).distance({2, 1}), std::max(0.25 / 4, 0.2 / 4), 1e-6);
  Random random(9);
  for (int k = 0; k < 300; ++k) {
    const BezierPatch patch = quadric(uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1));
    const ChordBound bound(patch, true);
    EXPECT_LE(found_distance(patch, {0, 0, 1, 1}, random, 12, 30), bound.distance({1, 1}));
  }
}

/// An S-shaped profile: its middle lies on the chord, where sampling would find nothing.
TEST(ChordBound, SeesTheSShape) {
  std::vector<Vec3> points;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 2; ++j) points.push_back({i / 3.0, double(j), i == 1 ? 1.0 : i == 2 ? -1.0 : 0.0});
  const ChordBound bound(polynomial(3, 1, points));
  // z = 3 t (1-t)^2 - 3 t^2 (1-t) = 3 t (1-t) (1-2t): largest at t = (3 - sqrt 3) / 6, where it is 1 / (2 sqrt 3).
  EXPECT_GE(bound.distance({1, 1}), 0.28867513459481287);
  EXPECT_LE(bound.distance({1, 1}), 18.0 / 8 + 1e-6);
  // In halves the second derivative is linear: 18 at the end.
  EXPECT_NEAR(bound.distance({2, 1}), 18.0 / 4 / 8, 1e-6);
}

TEST(ChordBound, ABilinearPatchIsExact) {
  // Twist vector (0,0,1) times 1: the largest distance over a cell h x k is h k / 4.
  const ChordBound bound(polynomial(1, 1, {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 1}}));
  EXPECT_NEAR(bound.distance({1, 1}), 0.25, 1e-6);
  EXPECT_NEAR(bound.distance({4, 5}), 0.25 / 20, 1e-6);
}

TEST(ChordBound, APlaneNeedsOneCell) {
  std::vector<Vec3> points;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) points.push_back({3.0 * i, 5.0 * j, 2.0 * i - j});
  const ChordBound bound(polynomial(3, 3, points));
  EXPECT_LE(bound.distance({1, 1}), 1e-11);
  const auto rates = bound.cheapest(1e-6, 4096);
  ASSERT_TRUE(rates);
  EXPECT_EQ(rates->u, 1);
  EXPECT_EQ(rates->v, 1);
}

TEST(ChordBound, HugeAndTinyPatches) {
  Random random(3);
  const std::vector<Vec3> points = random_points(random, 3, 3);
  for (const double size : {1e-300, 1e-30, 1e30, 1e300}) {
    std::vector<Vec3> scaled;
    for (const Vec3& p : points) scaled.push_back(size * p);
    const double expected = ChordBound(polynomial(3, 3, points)).distance({4, 5});
    EXPECT_NEAR(ChordBound(polynomial(3, 3, scaled)).distance({4, 5}) / size, expected, 1e-9 * expected) << size;
  }
}

/// The fewest cells, found by trying all rates.
TEST(ChordBound, TheCheapestRatesAreTheCheapest) {
  Random random(5);
  for (int kind = 0; kind < 200; ++kind) {
    const BezierPatch patch = random_patch(random, kind);
    const ChordBound bound(patch, kind % 3 == 0);
    const double tolerance = bound.distance({1, 1}) * std::exp(uniform(random, -7, 0.2));
    int least = 1 << 30;
    for (int u = 1; u <= 256; ++u)
      for (int v = 1; v <= 256 && u * v < least; ++v)
        if (bound.distance({u, v}) <= tolerance) least = u * v;
    const auto rates = bound.cheapest(tolerance, 256);
    ASSERT_EQ(rates.has_value(), least < 1 << 30) << kind;
    if (!rates) continue;
    EXPECT_LE(bound.distance(*rates), tolerance);
    EXPECT_LE(rates->u * rates->v, 1.03 * least) << kind << ": " << rates->u << " x " << rates->v;
  }
}

TEST(ChordBound, RatesBeyondTheCapAreRefused) {
  Random random(7);
  const ChordBound bound(random_polynomial(random, 3, 3));
  EXPECT_FALSE(bound.cheapest(1e-12, 4096));
  EXPECT_FALSE(bound.cheapest(bound.distance({8, 8}) / 2, 8));
  EXPECT_TRUE(bound.cheapest(bound.distance({8, 8}), 8));
}

}}  // namespace tessera::test
