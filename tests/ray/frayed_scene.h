#pragma once
// A scene of a closed shape whose faces fail to meet along their edges.

#include <vector>

#include "ray/gaping_shapes.h"
#include "ray_support.h"
#include "support/solid_rays.h"

namespace tessera::test {

/// A frayed cube, with rays at its edges.
struct Frayed {
  Shape shape = FrayedCube({1e-3}, 7).shape();
  PatchSet set = value_of(make_patch_set(shape));
  RayScene scene = value_of(RayScene::make(set));

  std::vector<Ray> at_edges(std::size_t count, std::uint64_t seed) const {
    Random random(seed);
    const EdgeTargets targets(shape);
    std::vector<Ray> rays;
    while (rays.size() < count) {  // neighbours in packets
      const Vec3 at = targets.draw(random), eye = Vec3{0.5, 0.5, 0.5} + 3 * normalized(random_direction(random));
      for (int k = 0; k < 16; ++k) rays.push_back(ray(eye, at + 2e-3 * uniform_vector(random, -1, 1) - eye));
    }
    return rays;
  }
};

}  // namespace tessera::test
