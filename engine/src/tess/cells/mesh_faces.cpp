#include "tess/cells/mesh_faces.h"

#include <string>

#include "base/text.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

Status bad_face(const char* face, std::size_t place, const std::string& why) {
  return {StatusCode::invalid_argument, std::string(face) + " " + std::to_string(place) + " " + why,
          static_cast<std::ptrdiff_t>(place)};
}

}  // namespace

Status check_face_corners(const char* face, std::span<const std::uint32_t> indices, std::size_t corners,
                          std::size_t vertices) {
  for (std::size_t k = 0; k < indices.size(); ++k)
    if (indices[k] >= vertices)
      return bad_face(face, k / corners,
                      "has the vertex " + std::to_string(indices[k]) + ", there are " + std::to_string(vertices));
  return {};
}

Status check_face_patches(const Mesh& mesh, std::size_t patches) {
  const auto check = [&](const char* face, std::span<const std::uint32_t> of, std::size_t faces) -> Status {
    if (of.size() != faces)
      return {StatusCode::count_mismatch, counted(of.size(), "patch", "patches") + " for " + counted(faces, face)};
    for (std::size_t k = 0; k < of.size(); ++k)
      if (of[k] >= patches)
        return bad_face(face, k, "is of patch " + std::to_string(of[k]) + ", there are " + std::to_string(patches));
    return {};
  };
  const Status status = check("triangle", mesh.patches, mesh.triangle_count());
  return status.ok() ? check("quad", mesh.quad_patches, mesh.quad_count()) : status;
}

}}  // namespace tessera::abi_0_1
