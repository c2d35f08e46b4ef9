#pragma once
// Sets of patches with shared borders and known shape, for tests and benchmarks alike.

#include <cmath>
#include <cstdlib>
#include <iostream>
#include <utility>
#include <vector>

#include "tessera/bezier_patch.h"
#include "tessera/patch_set.h"

namespace tessera::test {

/// The value of a result that must be good; otherwise prints the message and ends the program.
template <class T>
T value_of(Result<T> result) {
  if (!result) {
    std::cerr << result.status().message() << '\n';
    std::abort();
  }
  return *std::move(result);
}

/// The points moved and scaled: scale * p + shift.
inline std::vector<BezierPatch> placed(const std::vector<BezierPatch>& patches, double scale, const Vec3& shift) {
  std::vector<BezierPatch> out;
  for (const BezierPatch& patch : patches) {
    std::vector<Vec3> points(patch.points().begin(), patch.points().end());
    for (Vec3& p : points) p = scale * p + shift;
    out.push_back(patch.is_rational()
                      ? value_of(BezierPatch::rational(patch.degree_u(), patch.degree_v(), points, patch.weights()))
                      : value_of(BezierPatch::polynomial(patch.degree_u(), patch.degree_v(), points)));
  }
  return out;
}

/// A height field of nu x nv bicubic patches over [0, nu] x [0, nv] with gentle waves of height about 1; patch
/// (a, b) has the index a * nv + b. Neighbours share the control points of their border.
inline std::vector<BezierPatch> wavy_field(int nu, int nv) {
  const auto height = [](double x, double y) {
    return 0.5 * std::sin(0.9 * x + 0.3 * y) + 0.35 * std::cos(0.7 * y - 0.2 * x) +
           0.15 * std::sin(2.1 * x) * std::cos(1.9 * y);
  };
  std::vector<BezierPatch> patches;
  for (int a = 0; a < nu; ++a) {
    for (int b = 0; b < nv; ++b) {
      std::vector<Vec3> points;
      for (int i = 0; i <= 3; ++i) {
        for (int j = 0; j <= 3; ++j) {
          const double x = (3 * a + i) / 3.0, y = (3 * b + j) / 3.0;
          points.push_back({x, y, height(x, y)});
        }
      }
      patches.push_back(value_of(BezierPatch::polynomial(3, 3, points)));
    }
  }
  return patches;
}

/// Six bicubic patches over the faces of a cube, blown up and dented: a closed body of size about 3 that contains the
/// ball of radius 0.5 about zero. Faces share border points; their parameters run in various directions.
inline std::vector<BezierPatch> closed_body() {
  const auto place = [](int ix, int iy, int iz) -> Vec3 {
    const Vec3 cube{(ix - 1.5) / 1.5, (iy - 1.5) / 1.5, (iz - 1.5) / 1.5};
    const Vec3 p = 0.45 * cube + 0.75 * normalized(cube);
    return {p.x * (1 + 0.15 * p.z), 0.85 * p.y + 0.1 * p.x * p.z, 1.1 * p.z - 0.1 * p.x * p.y};
  };
  std::vector<BezierPatch> patches;
  for (int face = 0; face < 6; ++face) {
    std::vector<Vec3> points;
    for (int i = 0; i <= 3; ++i) {
      for (int j = 0; j <= 3; ++j) {
        const int fixed = face % 2 == 0 ? 0 : 3, k = face == 1 || face == 4 ? 3 - i : i;
        if (face / 2 == 0) points.push_back(place(fixed, k, j));
        if (face / 2 == 1) points.push_back(place(j, fixed, k));
        if (face / 2 == 2) points.push_back(place(k, j, fixed));
      }
    }
    patches.push_back(value_of(BezierPatch::polynomial(3, 3, points)));
  }
  return patches;
}

/// The unit sphere in eight rational biquadratic octants with poles at +-z: each is the octant of The NURBS Book,
/// section 8.3, mirrored.
inline std::vector<BezierPatch> sphere() {
  std::vector<BezierPatch> patches;
  const double s = std::sqrt(2.0) / 2;
  const double w[3] = {1, s, 1};
  for (int octant = 0; octant < 8; ++octant) {
    const double x = octant & 1 ? -1 : 1, y = octant & 2 ? -1 : 1, z = octant & 4 ? -1 : 1;
    const std::vector<Vec3> points{{x, 0, 0}, {x, y, 0}, {0, y, 0}, {x, 0, z}, {x, y, z},
                                   {0, y, z}, {0, 0, z}, {0, 0, z}, {0, 0, z}};
    std::vector<double> weights;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) weights.push_back(w[i] * w[j]);
    }
    patches.push_back(value_of(BezierPatch::rational(2, 2, points, weights)));
  }
  return patches;
}

}  // namespace tessera::test
