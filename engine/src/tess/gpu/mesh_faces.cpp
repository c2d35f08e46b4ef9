#include "tess/gpu/mesh_faces.h"

#include <string>

#include "base/text.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

Status bad_face(const char* face, std::size_t place, const std::string& why) {
  return {StatusCode::invalid_argument, std::string(face) + " " + std::to_string(place) + " " + why,
          static_cast<std::ptrdiff_t>(place)};
}

}  // namespace

Status check_corners(const char* face, std::span<const std::uint32_t> indices, std::size_t corners,
                     std::size_t vertices) {
  for (std::size_t k = 0; k < indices.size(); ++k)
    if (indices[k] >= vertices)
      return bad_face(face, k / corners,
                      "has the vertex " + std::to_string(indices[k]) + ", there are " + std::to_string(vertices));
  return {};
}

Status check_patches(const Mesh& mesh, std::size_t patches) {
  if (!mesh.has_patches()) return {StatusCode::invalid_argument, "the mesh has not one patch for each face"};
  const auto check = [&](const char* face, std::span<const std::uint32_t> of) {
    for (std::size_t k = 0; k < of.size(); ++k)
      if (of[k] >= patches)
        return bad_face(face, k, "is of patch " + std::to_string(of[k]) + ", there are " + std::to_string(patches));
    return Status();
  };
  const Status status = check("triangle", mesh.patches);
  return status.ok() ? check("quad", mesh.quad_patches) : status;
}

}}  // namespace tessera::abi_0_1
