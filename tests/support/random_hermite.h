#pragma once
// Seeded random corners, nodes and knots of Hermite patches.

#include "support/random_patches.h"
#include "support/synthetic_sets.h"
#include "tessera/hermite_patch.h"

namespace tessera::test {

/// A node over (x, y), with tangents near (1,0,0) and (0,1,0) times the spacings, so that normals exist.
inline HermiteNode random_node(Random& random, double x, double y, double h = 1, double g = 1) {
  return {Vec3{x, y, 0} + 0.1 * uniform_vector(random, -1, 1),
          h * (Vec3{1, 0, 0} + 0.4 * uniform_vector(random, -1, 1)),
          g * (Vec3{0, 1, 0} + 0.4 * uniform_vector(random, -1, 1)), (h * g) * uniform_vector(random, -1, 1)};
}
inline HermitePatch::Grid random_grid(Random& random) {
  HermitePatch::Grid grid;
  for (Vec3& vector : grid) vector = uniform_vector(random, -1, 1);
  return grid;
}
inline HermitePatch random_hermite(Random& random, const Domain& domain = {}) {
  return value_of(HermitePatch::make(random_grid(random), domain));
}
inline std::vector<HermiteNode> random_nodes(Random& random, std::size_t count_u, std::size_t count_v) {
  std::vector<HermiteNode> nodes;
  for (std::size_t i = 0; i < count_u; ++i)
    for (std::size_t j = 0; j < count_v; ++j)
      nodes.push_back(random_node(random, static_cast<double>(i), static_cast<double>(j)));
  return nodes;
}
/// 1, then factors in [1/2, 2).
inline std::vector<double> random_factors(Random& random, std::size_t spans) {
  std::vector<double> factors(spans, 1);
  for (std::size_t i = 1; i < spans; ++i) factors[i] = std::exp2(uniform(random, -1, 1));
  return factors;
}
/// Increasing, with spacings in [1/2, 2).
inline std::vector<double> random_knots(Random& random, std::size_t count, double start = 0) {
  std::vector<double> knots{start};
  while (knots.size() < count) knots.push_back(knots.back() + std::exp2(uniform(random, -1, 1)));
  return knots;
}

}  // namespace tessera::test
