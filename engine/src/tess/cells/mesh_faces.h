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

/// Faces of one patch that follow each other.
struct FaceRun {
  std::uint32_t patch;
  bool is_quads;
  std::size_t first_triangle, first_quad;  ///< the number of the run's first face, and of the next of the other kind
  std::size_t count;
};
/// Returns the places behind the last values of runs of equal ones, found by all threads. Throws std::bad_alloc.
std::vector<std::size_t> run_ends(std::span<const std::uint32_t> values);

/// Calls visit(run) for all faces in the order of the patches, the next triangles or quads with the lower one.
/// check_face_patches() has checked the mesh. Ends at an error of a visit, which it returns.
template <class Visit>
Status for_faces_by_patch(const Mesh& mesh, Visit visit) {
  const std::vector<std::size_t> triangle_ends = run_ends(mesh.patches), quad_ends = run_ends(mesh.quad_patches);
  auto triangle_end = triangle_ends.begin(), quad_end = quad_ends.begin();
  for (std::size_t t = 0, q = 0; t < mesh.patches.size() || q < mesh.quad_patches.size();) {
    const bool is_quads =
        t == mesh.patches.size() || (q < mesh.quad_patches.size() && mesh.quad_patches[q] < mesh.patches[t]);
    const std::size_t end = is_quads ? *quad_end++ : *triangle_end++;
    const Status status =
        visit(FaceRun{is_quads ? mesh.quad_patches[q] : mesh.patches[t], is_quads, t, q, end - (is_quads ? q : t)});
    if (!status.ok()) return status;
    (is_quads ? q : t) = end;
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
