#include <functional>
#include <optional>
#include <string>

#include "base/text.h"
#include "model/surface_face.h"
#include "tess/cells/mesh_faces.h"
#include "tess/mesh/mesh_parts.h"
#include "tessera/guard.h"
#include "tessera/mesh_assembly.h"
#include "tessera/model.h"
#include "tessera/tessellation.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// The surfaces that parts are named after.
struct Surfaces {
  const char* kind;  ///< "surface"
  std::size_t count;
  std::function<const std::string&(std::size_t)> name;
  std::function<std::optional<Colour>(std::size_t)> colour;

  /// A part of a surface, without faces yet.
  MeshPart part(std::size_t surface) const {
    MeshPart part{.name = name(surface), .colour = colour(surface)};
    if (part.name.empty()) part.name = kind + (" " + std::to_string(surface));
    return part;
  }
};

/// The colour of a model's surface, if it is the face of an instance.
std::optional<Colour> colour_of(const Model& model, std::size_t surface) {
  const std::optional<SurfaceFace> face = face_of_surface(model, surface);
  return face ? face->colour() : std::nullopt;
}

/// Builds parts of the faces of one surface after the other.
class PartList {
 public:
  PartList(const PatchSet& set, const Surfaces& surfaces) : set_(set), surfaces_(surfaces) {}

  /// Errors: invalid_argument (no such surface).
  Status add(const FaceRun& run) {
    const std::size_t surface = set_.source(run.patch).surface;
    if (surface >= surfaces_.count) {
      const std::size_t face = run.is_quads ? run.first_quad : run.first_triangle;
      return {StatusCode::invalid_argument,
              std::string(run.is_quads ? "quad " : "triangle ") + std::to_string(face) + " is of " + surfaces_.kind +
                  " " + std::to_string(surface) + ", there are " + std::to_string(surfaces_.count),
              static_cast<std::ptrdiff_t>(face)};
    }
    if (parts_.empty() || surface != surface_) {
      parts_.push_back(surfaces_.part(surface));
      parts_.back().first_triangle = run.first_triangle;
      parts_.back().first_quad = run.first_quad;
    }
    surface_ = surface;
    (run.is_quads ? parts_.back().quad_count : parts_.back().triangle_count) += run.count;
    return {};
  }

  std::vector<MeshPart> take() && { return std::move(parts_); }

 private:
  const PatchSet& set_;
  const Surfaces& surfaces_;
  std::vector<MeshPart> parts_;
  std::size_t surface_ = 0;  ///< that of the last part
};

Result<std::vector<MeshPart>> parts_of(const Mesh& mesh, const PatchSet& set, const Surfaces& surfaces) {
  if (Status status = check_face_patches(mesh, set.patch_count()); !status.ok()) return status;
  PartList parts(set, surfaces);
  const Status status = for_faces_by_patch(mesh, [&](const FaceRun& run) { return parts.add(run); });
  if (!status.ok()) return status;
  return std::move(parts).take();
}

}  // namespace

Status check_parts(const Mesh& mesh) {
  std::size_t triangle = 0, quad = 0;
  for (std::size_t k = 0; k < mesh.parts.size(); ++k) {
    const MeshPart& part = mesh.parts[k];
    if (part.first_triangle != triangle || part.triangle_count > mesh.triangle_count() - triangle ||
        (part.quad_count > 0 && part.first_quad != quad) || part.quad_count > mesh.quad_count() - quad)
      return {
          StatusCode::invalid_argument,
          "part " + std::to_string(k) + " of the mesh must begin where the one before ends, and stay within its faces",
          static_cast<std::ptrdiff_t>(k)};
    triangle += part.triangle_count;
    quad += part.quad_count;
  }
  const auto check_all = [](const char* faces, std::size_t of_parts, std::size_t of_mesh) -> Status {
    if (of_parts == of_mesh) return {};
    return {StatusCode::count_mismatch, "the mesh's parts have " + std::to_string(of_parts) + " " + faces +
                                            ", the mesh " + std::to_string(of_mesh)};
  };
  if (mesh.parts.empty()) return {};
  const Status status = check_all("triangles", triangle, mesh.triangle_count());
  return status.ok() ? check_all("quads", quad, mesh.quad_count()) : status;
}

Result<std::vector<MeshPart>> parts_by_surface(const Mesh& mesh, const PatchSet& set, const Model& model) {
  return guarded([&] {
    return parts_of(mesh, set,
                    {.kind = "surface",
                     .count = model.surfaces.size(),
                     .name = [&](std::size_t k) -> const std::string& { return *model.surfaces[k].name; },
                     .colour = [&](std::size_t k) { return colour_of(model, k); }});
  });
}

Result<std::vector<MeshPart>> parts_by_face(const Mesh& mesh, const PatchSet& set, const Shape& shape) {
  return guarded([&] {
    return parts_of(mesh, set,
                    {.kind = "face",
                     .count = shape.faces.size(),
                     .name = [&](std::size_t k) -> const std::string& { return *shape.faces[k].name; },
                     .colour = [&](std::size_t k) { return shape.faces[k].colour; }});
  });
}

}}  // namespace tessera::abi_0_1
