#pragma once
// Patches whose borders differ a little, as those of files do.

#include <cstdint>
#include <vector>

#include "support/synthetic_sets.h"
#include "tess/tessellate_support.h"

namespace tessera::test {

/// Every control point of every patch moved on its own by up to `by`, and the patches turned.
inline std::vector<BezierPatch> shaken(const std::vector<BezierPatch>& patches, double by, std::uint64_t seed) {
  Random random(seed);
  std::vector<BezierPatch> out;
  for (const BezierPatch& patch : patches) {
    std::vector<Vec3> points(patch.points().begin(), patch.points().end());
    for (Vec3& p : points) p = p + by * uniform_vector(random, -1, 1);
    out.push_back(reoriented(good(patch.with_points(points)), static_cast<int>(random() % 8)));
  }
  return out;
}

}  // namespace tessera::test
