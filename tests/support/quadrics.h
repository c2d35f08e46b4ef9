#pragma once
// Quadrics of every kind, at any place.

#include <array>

#include "support/random_patches.h"
#include "support/synthetic_sets.h"
#include "tessera/quadric.h"

namespace tessera::test {

inline Quadric quadric(const QuadricCoefficients& coefficients, const QuadricOptions& options = {}) {
  return value_of(Quadric::make(coefficients, options));
}
inline QuadricPiece piece(const Quadric& surface, const Domain& range, int sheet = 0) {
  return value_of(QuadricPiece::make(surface, range, sheet));
}

using Matrix4 = std::array<std::array<long double, 4>, 4>;

/// The quadric q moved so that its frame is `frame`: Q' = T^-1 Q T^-T for points P' = P T.
inline QuadricCoefficients moved(const QuadricCoefficients& q, const QuadricFrame& frame) {
  const Matrix4 matrix{{{q.a, q.d, q.f, q.g}, {q.d, q.b, q.e, q.h}, {q.f, q.e, q.c, q.j}, {q.g, q.h, q.j, q.k}}};
  Matrix4 inverse{};  // local = [P 1] inverse
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3& axis = frame.axes[k];
    inverse[0][k] = axis.x, inverse[1][k] = axis.y, inverse[2][k] = axis.z;
    const Vec3& o = frame.origin;
    inverse[3][k] = -(static_cast<long double>(o.x) * axis.x + static_cast<long double>(o.y) * axis.y +
                      static_cast<long double>(o.z) * axis.z);
  }
  inverse[3][3] = 1;
  const auto at = [&](std::size_t i, std::size_t j) {
    long double sum = 0;
    for (std::size_t k = 0; k < 4; ++k)
      for (std::size_t l = 0; l < 4; ++l) sum += inverse[i][k] * matrix[k][l] * inverse[j][l];
    return static_cast<double>(sum);
  };
  return {at(0, 0), at(1, 1), at(2, 2), at(0, 1), at(1, 2), at(0, 2), at(0, 3), at(1, 3), at(2, 3), at(3, 3)};
}

/// A random rotation and a place within `distance` of zero.
inline QuadricFrame random_frame(Random& random, double distance) {
  QuadricFrame frame;
  frame.axes[0] = normalized(uniform_vector(random, -1, 1));
  frame.axes[1] = normalized(cross(frame.axes[0], uniform_vector(random, -1, 1)));
  frame.axes[2] = cross(frame.axes[0], frame.axes[1]);
  frame.origin = distance * uniform_vector(random, -1, 1);
  return frame;
}

/// One of each kind in its canonical frame, with the sizes that the classification should find.
struct QuadricSample {
  QuadricKind kind;
  QuadricCoefficients coefficients;
  Vec3 size;
};
inline const std::array<QuadricSample, 19>& quadric_samples() {
  using Kind = QuadricKind;
  static const std::array<QuadricSample, 19> samples{{
      {Kind::ellipsoid, {.a = 0.25, .b = 1, .c = 4, .k = -1}, {2, 1, 0.5}},
      {Kind::hyperboloid_one_sheet, {.a = 0.25, .b = 1, .c = -4, .k = -1}, {2, 1, 0.5}},
      {Kind::hyperboloid_two_sheets, {.a = -0.25, .b = -1, .c = 4, .k = -1}, {2, 1, 0.5}},
      {Kind::elliptic_cone, {.a = 0.25, .b = 4, .c = -1}, {2, 0.5, 1}},
      {Kind::elliptic_paraboloid, {.a = 0.25, .b = 4, .j = -0.5}, {2, 0.5, 1}},
      {Kind::hyperbolic_paraboloid, {.a = 0.25, .b = -4, .j = -0.5}, {2, 0.5, 1}},
      {Kind::elliptic_cylinder, {.a = 0.25, .b = 4, .k = -1}, {2, 0.5, 1}},
      {Kind::hyperbolic_cylinder, {.a = 0.25, .b = -4, .k = -1}, {2, 0.5, 1}},
      {Kind::parabolic_cylinder, {.a = 0.25, .j = -0.5}, {2, 1, 1}},
      {Kind::intersecting_planes, {.a = 0.64, .b = -0.36}, {0.6, 0.8, 1}},
      {Kind::parallel_planes, {.a = 0.25, .k = -1}, {2, 1, 1}},
      {Kind::coincident_planes, {.a = 3}, {1, 1, 1}},
      {Kind::plane, {.g = 2}, {1, 1, 1}},
      {Kind::line, {.a = 1, .b = 4}, {1, 0.5, 1}},
      {Kind::point, {.a = 0.25, .b = 4, .c = 1}, {2, 0.5, 1}},
      {Kind::imaginary_ellipsoid, {.a = 0.25, .b = 1, .c = 4, .k = 1}, {2, 1, 0.5}},
      {Kind::imaginary_cylinder, {.a = 0.25, .b = 4, .k = 1}, {2, 0.5, 1}},
      {Kind::imaginary_planes, {.a = 0.25, .k = 1}, {2, 1, 1}},
      {Kind::empty, {.k = -3}, {1, 1, 1}},
  }};
  return samples;
}

/// Ranges that each kind has, wide enough for several patches where it is curved.
inline Domain sample_range(QuadricKind kind) {
  switch (kind) {
    case QuadricKind::ellipsoid:
      return {-1, 4, -1.2, 1.5};
    case QuadricKind::hyperboloid_one_sheet:
    case QuadricKind::elliptic_cone:
    case QuadricKind::elliptic_cylinder:
      return {0.5, 5, -1.5, 2};
    case QuadricKind::hyperboloid_two_sheets:
    case QuadricKind::elliptic_paraboloid:
      return {0.5, 5, 0.25, 3};
    case QuadricKind::hyperbolic_cylinder:
      return {-3, 2, -1, 4};
    default:
      return {-2, 1, -0.5, 3};
  }
}

}  // namespace tessera::test
