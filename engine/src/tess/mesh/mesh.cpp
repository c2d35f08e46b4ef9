#include "tessera/mesh.h"

#include "tess/mesh/mesh_parts.h"
#include "tessera/guard.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Makes triangles of all faces, part by part.
class QuadSplitter {
 public:
  explicit QuadSplitter(const Mesh& mesh) : mesh_(mesh), has_patches_(mesh.has_patches()) {
    const std::size_t triangles = mesh.triangle_count() + 2 * mesh.quad_count();
    indices_.reserve(3 * triangles);
    if (has_patches_) patches_.reserve(triangles);
  }

  /// Adds the triangles of a part and returns the first.
  std::size_t add(const MeshPart& part) {
    const std::size_t first = indices_.size() / 3;
    const auto at = [](const auto& values, std::size_t k) { return values.begin() + static_cast<std::ptrdiff_t>(k); };
    const std::size_t end = part.first_triangle + part.triangle_count;
    indices_.insert(indices_.end(), at(mesh_.indices, 3 * part.first_triangle), at(mesh_.indices, 3 * end));
    if (has_patches_) patches_.insert(patches_.end(), at(mesh_.patches, part.first_triangle), at(mesh_.patches, end));
    for (std::size_t k = part.first_quad; k < part.first_quad + part.quad_count; ++k) {
      const std::uint32_t* const corner = mesh_.quads.data() + 4 * k;
      indices_.insert(indices_.end(), {corner[0], corner[1], corner[2], corner[0], corner[2], corner[3]});
      if (has_patches_) patches_.insert(patches_.end(), 2, mesh_.quad_patches[k]);
    }
    return first;
  }

  void put_into(Mesh& mesh) && {
    mesh.indices = std::move(indices_);
    mesh.patches = std::move(patches_);
  }

 private:
  const Mesh& mesh_;
  bool has_patches_;
  std::vector<std::uint32_t> indices_, patches_;
};

}  // namespace

MeshViews Mesh::views() {
  MeshViews views;
  views.position = View3<float>::interleaved(positions);
  if (!normals.empty()) views.normal = View3<float>::interleaved(normals);
  if (!parameters.empty()) views.parameter = View2<float>::interleaved(parameters);
  views.patch = patches;
  views.indices = indices;
  views.quads = quads;
  views.quad_patch = quad_patches;
  if (!model_positions.empty()) views.model_position = View3<double>::interleaved(model_positions);
  return views;
}

Result<Mesh> split_quads(const Mesh& mesh) {
  return guarded([&]() -> Result<Mesh> {
    if (mesh.indices.size() % 3 != 0 || mesh.quads.size() % 4 != 0)
      return Status(StatusCode::count_mismatch, std::to_string(mesh.indices.size()) + " indices of triangles and " +
                                                    std::to_string(mesh.quads.size()) +
                                                    " of quads are not three per triangle and four per quad");
    if (Status status = check_parts(mesh); !status.ok()) return status;
    if (mesh.quads.empty()) return mesh;
    Mesh split;
    split.origin = mesh.origin;
    split.positions = mesh.positions;
    split.model_positions = mesh.model_positions;
    split.normals = mesh.normals;
    split.parameters = mesh.parameters;
    split.parts = mesh.parts;
    QuadSplitter splitter(mesh);
    for (MeshPart& part : split.parts) {
      const std::size_t first = splitter.add(part);
      part = {std::move(part.name), first, part.triangle_count + 2 * part.quad_count, 0, 0, part.colour};
    }
    if (split.parts.empty()) splitter.add({{}, 0, mesh.triangle_count(), 0, mesh.quad_count()});
    std::move(splitter).put_into(split);
    return split;
  });
}

}}  // namespace tessera::abi_0_1
