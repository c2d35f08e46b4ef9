#pragma once
// Closed bodies of patches that share the control points of a lattice on a cube's sides.

#include <array>
#include <cstddef>
#include <map>
#include <vector>

#include "ray_support.h"

namespace tessera::test {

/// The measures of a lattice body.
struct LatticeBody {
  int patches_per_side = 3;  ///< of the cube, in each direction
  int degree = 3;
  double noise = 0;  ///< largest random offset of a control point's coordinates; the body itself is round, of size 2
};

/// Makes the body. Patches that share a border have equal control points there.
inline std::vector<BezierPatch> lattice_body(const LatticeBody& body, Random& random) {
  const int count = body.patches_per_side, degree = body.degree, last = count * degree;
  std::map<std::array<int, 3>, Vec3> lattice;
  const auto point = [&](const std::array<int, 3>& at) {
    const auto place = [&](std::size_t k) { return 2.0 * at[k] / last - 1; };
    const auto [found, is_new] = lattice.try_emplace(at);
    if (is_new)
      found->second = normalized(Vec3{place(0), place(1), place(2)}) + body.noise * uniform_vector(random, -1, 1);
    return found->second;
  };
  std::vector<BezierPatch> patches;
  for (std::size_t side = 0; side < 6; ++side)
    for (int piece = 0; piece < count * count; ++piece) {
      std::vector<Vec3> points;
      for (int i = 0; i <= degree; ++i)
        for (int j = 0; j <= degree; ++j) {
          const std::size_t axis = side / 2, along = (axis + 1 + side % 2) % 3, across = (axis + 2 - side % 2) % 3;
          std::array<int, 3> at;
          at[axis] = side % 2 == 0 ? last : 0;
          at[along] = piece / count * degree + i, at[across] = piece % count * degree + j;
          points.push_back(point(at));
        }
      patches.push_back(polynomial(degree, degree, points));
    }
  return patches;
}

}  // namespace tessera::test
