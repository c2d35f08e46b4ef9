#pragma once
// Checks of a mesh's faces before they are prepared for a GPU.

#include <cstddef>
#include <cstdint>
#include <span>

#include "tessera/mesh.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// Checks that each corner is a vertex. `corners`: of each face. Errors: invalid_argument (index = the face).
Status check_corners(const char* face, std::span<const std::uint32_t> indices, std::size_t corners,
                     std::size_t vertices);
/// Checks that the mesh has a patch for each face, below a number of patches. Errors: invalid_argument (index = the
/// face).
Status check_patches(const Mesh& mesh, std::size_t patches);

/// Returns a vertex in the model.
inline Vec3 vertex_of(const Mesh& mesh, std::size_t vertex) {
  if (!mesh.model_positions.empty()) {
    const double* const p = mesh.model_positions.data() + 3 * vertex;
    return {p[0], p[1], p[2]};
  }
  const float* const p = mesh.positions.data() + 3 * vertex;
  return mesh.origin + Vec3{double(p[0]), double(p[1]), double(p[2])};
}

}}  // namespace tessera::abi_0_1
