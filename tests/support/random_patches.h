#pragma once
// Seeded random Bezier patches of any degree.

#include <gtest/gtest.h>

#include <cstdlib>
#include <random>
#include <vector>

#include "tessera/bezier_patch.h"

namespace tessera::test {

using Random = std::mt19937_64;

/// Uniform in [from, to).
inline double uniform(Random& random, double from, double to) {
  return from + (to - from) * static_cast<double>(random() >> 11) * 0x1p-53;
}
inline Vec3 uniform_vector(Random& random, double from, double to) {
  const double x = uniform(random, from, to), y = uniform(random, from, to), z = uniform(random, from, to);
  return {x, y, z};
}

/// The patch of a result that must be good; otherwise prints the message and ends the program.
inline BezierPatch patch_of(Result<BezierPatch> result) {
  if (!result) {
    ADD_FAILURE() << result.status().message();
    std::abort();
  }
  return *std::move(result);
}
inline BezierPatch polynomial(int degree_u, int degree_v, const std::vector<Vec3>& points) {
  return patch_of(BezierPatch::polynomial(degree_u, degree_v, points));
}
inline BezierPatch rational(int degree_u, int degree_v, const std::vector<Vec3>& points,
                            const std::vector<double>& weights) {
  return patch_of(BezierPatch::rational(degree_u, degree_v, points, weights));
}

/// Points in a cube of half-width `size` about `centre`.
inline std::vector<Vec3> random_points(Random& random, int degree_u, int degree_v, Vec3 centre = {}, double size = 1) {
  std::vector<Vec3> points(static_cast<std::size_t>((degree_u + 1) * (degree_v + 1)));
  for (Vec3& p : points) p = centre + size * uniform_vector(random, -1, 1);
  return points;
}
/// Weights in [lowest, highest), uniform in the logarithm.
inline std::vector<double> random_weights(Random& random, int degree_u, int degree_v, double lowest, double highest) {
  std::vector<double> weights(static_cast<std::size_t>((degree_u + 1) * (degree_v + 1)));
  for (double& w : weights) w = lowest * std::exp(uniform(random, 0, std::log(highest / lowest)));
  return weights;
}

inline BezierPatch random_polynomial(Random& random, int degree_u, int degree_v, Vec3 centre = {}, double size = 1) {
  return polynomial(degree_u, degree_v, random_points(random, degree_u, degree_v, centre, size));
}
inline BezierPatch random_rational(Random& random, int degree_u, int degree_v, double lowest = 0.25, double highest = 4,
                                   Vec3 centre = {}, double size = 1) {
  const std::vector<Vec3> points = random_points(random, degree_u, degree_v, centre, size);
  return rational(degree_u, degree_v, points, random_weights(random, degree_u, degree_v, lowest, highest));
}

/// The patch with u and v exchanged.
inline BezierPatch transposed(const BezierPatch& patch) {
  std::vector<Vec3> points;
  std::vector<double> weights;
  for (int j = 0; j <= patch.degree_v(); ++j)
    for (int i = 0; i <= patch.degree_u(); ++i) {
      points.push_back(patch.point(i, j));
      weights.push_back(patch.weight(i, j));
    }
  return rational(patch.degree_v(), patch.degree_u(), points, weights);
}
/// The patch with u turned into 1 - u.
inline BezierPatch reversed_u(const BezierPatch& patch) {
  std::vector<Vec3> points;
  std::vector<double> weights;
  for (int i = patch.degree_u(); i >= 0; --i)
    for (int j = 0; j <= patch.degree_v(); ++j) {
      points.push_back(patch.point(i, j));
      weights.push_back(patch.weight(i, j));
    }
  return rational(patch.degree_u(), patch.degree_v(), points, weights);
}
/// One of the eight ways to run the parameters over the same surface.
inline BezierPatch reoriented(const BezierPatch& patch, int way) {
  BezierPatch result = patch;
  if (way & 1) result = reversed_u(result);
  if (way & 2) result = transposed(reversed_u(transposed(result)));
  if (way & 4) result = transposed(result);
  return result;
}

}  // namespace tessera::test
