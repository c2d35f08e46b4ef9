#pragma once
// The faces of a mesh, triangles and quads: checks of their numbers, and the order of their patches.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "tessera/mesh.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// Checks that each corner is a vertex. `corners`: of each face. Errors: invalid_argument (index = the face).
Status check_face_corners(const char* face, std::span<const std::uint32_t> indices, std::size_t corners,
                          std::size_t vertices);
/// Checks that the mesh has a patch for each face, below a number of patches. Errors: count_mismatch, invalid_argument
/// (index = the face).
Status check_face_patches(const Mesh& mesh, std::size_t patches);

/// Calls visit(patch, is_quad, t, q) for each face in the order of the patches, the next triangle or quad with the
/// lower one: triangle `t`, or quad `q`. check_face_patches() has checked the mesh. Ends at an error of a visit, which
/// it returns.
template <class Visit>
Status for_faces_by_patch(const Mesh& mesh, Visit visit) {
  for (std::size_t t = 0, q = 0; t < mesh.patches.size() || q < mesh.quad_patches.size();) {
    const bool is_quad =
        t == mesh.patches.size() || (q < mesh.quad_patches.size() && mesh.quad_patches[q] < mesh.patches[t]);
    if (Status status = visit(is_quad ? mesh.quad_patches[q] : mesh.patches[t], is_quad, t, q); !status.ok())
      return status;
    ++(is_quad ? q : t);
  }
  return {};
}

/// Returns the k-th of vectors of three numbers each.
template <class Number>
Vec3 vector_at(const std::vector<Number>& values, std::size_t k) {
  return {double(values[3 * k]), double(values[3 * k + 1]), double(values[3 * k + 2])};
}

/// Returns a vertex in the model.
inline Vec3 vertex_of(const Mesh& mesh, std::size_t vertex) {
  return mesh.model_positions.empty() ? mesh.origin + vector_at(mesh.positions, vertex)
                                      : vector_at(mesh.model_positions, vertex);
}

}}  // namespace tessera::abi_0_1
