#pragma once
// Short ways to sets and meshes that must be good.

#include "support/grids.h"
#include "support/random_patches.h"
#include "tessera/tessellation.h"

namespace tessera::test {

/// The value of a result that must be good; otherwise prints the message and ends the program.
template <class T>
T good(Result<T> result) {
  if (!result) {
    ADD_FAILURE() << result.status().message();
    std::abort();
  }
  return *std::move(result);
}

inline Mesh mesh_of(const PatchSet& set, const Tessellation& plan) {
  Mesh mesh = good(plan.allocate());
  const Status status = plan.run(set, mesh.views());
  EXPECT_TRUE(status.ok()) << status.message();
  return mesh;
}

inline Mesh tessellate(const PatchSet& set, int rate_u, int rate_v) {
  return mesh_of(set, good(Tessellation::make(set, {.rates = UniformRates{rate_u, rate_v}})));
}
inline Mesh tessellate(const std::vector<BezierPatch>& patches, int rate_u, int rate_v) {
  return tessellate(set_of(patches), rate_u, rate_v);
}

/// Patches of all kinds: some degrees, polynomial and rational, some with poles.
inline std::vector<BezierPatch> mixed_patches(std::uint64_t seed, int count) {
  Random random(seed);
  std::vector<BezierPatch> patches;
  for (int k = 0; k < count; ++k) {
    const int m = 1 + static_cast<int>(random() % 6), n = 1 + static_cast<int>(random() % 6);
    std::vector<Vec3> points = random_points(random, m, n);
    if (k % 5 == 0)
      for (int j = 0; j <= n; ++j) points[static_cast<std::size_t>(j)] = points[0];
    const std::vector<double> weights =
        k % 3 == 0 ? random_weights(random, m, n, 0.5, 2) : std::vector<double>(points.size(), 1);
    patches.push_back(rational(m, n, points, weights));
  }
  return patches;
}

}  // namespace tessera::test
