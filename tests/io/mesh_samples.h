#pragma once
// Meshes for the tests of the formats.

#include <random>

#include "tessera/mesh.h"

namespace tessera::test {

struct Attributes {
  bool normals = true, parameters = true, patches = true;
};

/// Vertices anywhere, triangles between any of them.
inline Mesh random_mesh(std::size_t vertices, std::size_t triangles, const Attributes& attributes = {},
                        const Vec3& origin = {}) {
  std::mt19937 random(static_cast<unsigned>(vertices));
  std::uniform_real_distribution<float> number(-100, 100);
  Mesh mesh;
  mesh.origin = origin;
  for (std::size_t k = 0; k < 3 * vertices; ++k) {
    mesh.positions.push_back(number(random));
    if (attributes.normals) mesh.normals.push_back(number(random) / 100);
    if (attributes.parameters && k < 2 * vertices) mesh.parameters.push_back(number(random));
  }
  for (std::size_t k = 0; k < 3 * triangles; ++k)
    mesh.indices.push_back(static_cast<std::uint32_t>(random() % vertices));
  for (std::size_t k = 0; attributes.patches && k < triangles; ++k)
    mesh.patches.push_back(static_cast<std::uint32_t>(k / 5));
  return mesh;
}

}  // namespace tessera::test
