#include <string>

#include "base/guard.h"
#include "tessera/model.h"
#include "tessera/tessellate.h"

namespace tessera {
namespace {

Status no_such(const char* what, std::size_t index, std::size_t count, std::size_t triangle) {
  return {StatusCode::invalid_argument,
          "triangle " + std::to_string(triangle) + " is of " + what + " " + std::to_string(index) + ", there are " +
              std::to_string(count),
          static_cast<std::ptrdiff_t>(triangle)};
}

std::string name_of(const Model& model, std::size_t surface) {
  const std::string& name = model.surfaces[surface].name;
  return name.empty() ? "surface " + std::to_string(surface) : name;
}

}  // namespace

Result<std::vector<MeshPart>> parts_by_surface(const Mesh& mesh, const PatchSet& set, const Model& model) {
  return guarded([&]() -> Result<std::vector<MeshPart>> {
    const std::size_t triangles = mesh.triangle_count();
    if (mesh.patches.size() != triangles)
      return Status(StatusCode::count_mismatch,
                    std::to_string(mesh.patches.size()) + " patches for " + std::to_string(triangles) + " triangles");
    std::vector<MeshPart> parts;
    std::size_t surface = 0;
    for (std::size_t k = 0; k < triangles; ++k) {
      const std::size_t patch = mesh.patches[k];
      if (k == 0 || patch != mesh.patches[k - 1]) {
        if (patch >= set.patch_count()) return no_such("patch", patch, set.patch_count(), k);
        const std::size_t next = set.source(patch).surface;
        if (next >= model.surfaces.size()) return no_such("surface", next, model.surfaces.size(), k);
        if (k == 0 || next != surface) parts.push_back({name_of(model, next), k, 0});
        surface = next;
      }
      ++parts.back().triangle_count;
    }
    return parts;
  });
}

}  // namespace tessera
