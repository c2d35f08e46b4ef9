#pragma once
// Rational patches that are difficult for the bounds of derivatives. Some have weights that fall off steeply, so that
// the derivative of the weight is large compared with the weight; others are nearly linear, so that second derivatives
// are small compared with their errors.

#include <vector>

#include "support/random_patches.h"
#include "support/reference.h"

namespace tessera::test {

inline constexpr double steep_weights[] = {1e-6, 1, 1e3, 1e6};

/// Bilinear, with the heaviest point at the origin: the largest |w V| does not predict the errors at u = v = 0.
inline BezierPatch steep_bilinear(double heaviest) {
  return rational(1, 1, {{-1, -0.7, 0.3}, {}, {0.3, -0.2, 0.1}, {1, 0.7, -0.3}}, {1, heaviest, 1, 1.5});
}

/// One point of another weight than the rest: at corner `place`, or in the middle for place 4. It lies at the origin
/// or at random.
inline BezierPatch with_one_weight(Random& random, int m, int n, int place, double weight, bool at_origin) {
  std::vector<Vec3> points = random_points(random, m, n);
  std::vector<double> weights = random_weights(random, m, n, 0.5, 2);
  const int i = place == 4 ? (m + 1) / 2 : place % 2 * m, j = place == 4 ? (n + 1) / 2 : place / 2 * n;
  const auto k = static_cast<std::size_t>(i * (n + 1) + j);
  weights[k] = weight;
  if (at_origin) points[k] = {};
  return rational(m, n, points, weights);
}

/// The border v = 0 passes the origin, from points on one side to their images on the other; the row next to it has the
/// weight, and lies close to the origin. Midway the derivative by v comes from differences of large terms.
inline BezierPatch with_one_row(Random& random, int m, int n, double weight) {
  std::vector<Vec3> points = random_points(random, m, n);
  std::vector<double> weights = random_weights(random, m, n, 0.5, 2);
  const auto index = [&](int i, int j) { return static_cast<std::size_t>(i * (n + 1) + j); };
  for (int i = 0; i <= m; ++i) {
    if (2 * i > m) points[index(i, 0)] = Vec3{} - points[index(m - i, 0)];
    points[index(i, 1)] = 1e-3 * points[index(i, 1)];
    weights[index(i, 1)] *= weight;
  }
  return rational(m, n, points, weights);
}

/// The border v = 0 passes the origin at u, within rounding of double. The other row has the weight, and points of the
/// size 1 / weight: the derivative by v at (u, 0) has a size of 1 and errors of the weight's size.
inline BezierPatch with_lost_derivative(Random& random, int m, double u, double weight) {
  std::vector<Vec3> points = random_points(random, m, 1);
  std::vector<double> weights = random_weights(random, m, 1, 0.5, 2);
  RealVec3 sum;
  for (int i = 0; i <= m; ++i) {
    const auto border = static_cast<std::size_t>(2 * i), inner = border + 1;
    points[inner] = (1 / weight) * points[inner];
    weights[inner] *= weight;
    const Real factor = reference_bernstein(m, i, u) * Real(weights[border]);
    if (i == m) points[border] = (-1 / factor * sum).rounded();
    sum = sum + factor * RealVec3{points[border].x, points[border].y, points[border].z};
  }
  return rational(m, 1, points, weights);
}

/// A plane with nearly even parameters, weights 1 within `spread`, beside the origin: second derivatives are small, but
/// their errors are not.
inline BezierPatch nearly_linear(Random& random, int m, int n, double spread) {
  const Vec3 corner = uniform_vector(random, -1, 1);
  const Vec3 along_u = uniform_vector(random, -0.3, 0.3), along_v = uniform_vector(random, -0.3, 0.3);
  std::vector<Vec3> points;
  for (int i = 0; i <= m; ++i)
    for (int j = 0; j <= n; ++j)
      points.push_back(corner + (static_cast<double>(i) / m) * along_u + (static_cast<double>(j) / n) * along_v);
  return rational(m, n, points, random_weights(random, m, n, 1 - spread, 1 + spread));
}

/// Steep patches about the origin, and nearly linear ones, in all orientations: one direction of `degree`, the other of
/// any degree up to it.
inline std::vector<BezierPatch> steep_patches(Random& random, int degree) {
  std::vector<BezierPatch> patches;
  const auto add = [&](auto make) {
    const int other = 1 + static_cast<int>(random() % static_cast<unsigned>(degree));
    const int way = static_cast<int>(random() % 8);
    patches.push_back(reoriented(random() % 2 ? make(degree, other) : make(other, degree), way));
  };
  for (const double weight : steep_weights) {
    for (int place = 0; place < 5; ++place)
      for (const bool at_origin : {true, false})
        add([&](int m, int n) { return with_one_weight(random, m, n, place, weight, at_origin); });
    for (int copy = 0; copy < 4; ++copy) add([&](int m, int n) { return with_one_row(random, m, n, weight); });
    for (int way = 0; way < 8; ++way) patches.push_back(reoriented(steep_bilinear(weight), way));
  }
  for (int copy = 0; copy < 16; ++copy) add([&](int m, int n) { return random_rational(random, m, n, 1, 1e6); });
  for (const double spread : {1e-9, 1e-3, 0.3})
    for (int copy = 0; copy < 8; ++copy) add([&](int m, int n) { return nearly_linear(random, m, n, spread); });
  return patches;
}

}  // namespace tessera::test
