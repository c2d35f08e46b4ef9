// The ranges of surfaces, and indices in 16 bits.

#include <algorithm>
#include <limits>
#include <string>

#include "base/text.h"
#include "tess/cells/mesh_faces.h"
#include "tessera/gpu_mesh.h"
#include "tessera/guard.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Collects ranges face by face.
class RangeList {
 public:
  RangeList(const Mesh& mesh, const PatchSet& set, std::span<const float> bounds)
      : mesh_(mesh), set_(set), bounds_(bounds) {}

  /// Adds the next face: triangle `t`, or quad `q`, which comes after `t` triangles.
  void add(std::uint32_t patch, bool is_quad, std::size_t t, std::size_t q) {
    const std::uint32_t surface = set_.source(patch).surface;
    if (ranges_.empty() || ranges_.back().surface != surface) {
      end();
      MeshRange& next = ranges_.emplace_back();
      next.surface = surface, next.first_triangle = t, next.first_quad = q;
      lowest_ = std::numeric_limits<std::size_t>::max(), highest_ = 0;
    }
    MeshRange& range = ranges_.back();
    ++(is_quad ? range.quad_count : range.triangle_count);
    range.bound =
        std::max(range.bound, bounds_.empty() ? std::numeric_limits<double>::infinity() : double(bounds_[patch]));
    const std::size_t corners = is_quad ? 4 : 3;
    const std::uint32_t* const corner = is_quad ? &mesh_.quads[4 * q] : &mesh_.indices[3 * t];
    for (std::size_t k = 0; k < corners; ++k) {
      lowest_ = std::min<std::size_t>(lowest_, corner[k]);
      highest_ = std::max<std::size_t>(highest_, corner[k]);
      range.box.extend(vertex_of(mesh_, corner[k]));
    }
  }
  std::vector<MeshRange> take() && {
    end();
    return std::move(ranges_);
  }

 private:
  void end() {
    if (!ranges_.empty()) ranges_.back().first_vertex = lowest_, ranges_.back().vertex_count = highest_ - lowest_ + 1;
  }

  const Mesh& mesh_;
  const PatchSet& set_;
  std::span<const float> bounds_;
  std::vector<MeshRange> ranges_;
  std::size_t lowest_ = 0, highest_ = 0;
};

}  // namespace

Result<std::vector<MeshRange>> surface_ranges(const Mesh& mesh, const PatchSet& set, std::span<const float> bounds) {
  return guarded([&]() -> Result<std::vector<MeshRange>> {
    if (Status status = check_face_patches(mesh, set.patch_count()); !status.ok()) return status;
    if (!bounds.empty() && bounds.size() != set.patch_count())
      return Status(StatusCode::count_mismatch,
                    counted(bounds.size(), "bound") + " for " + counted(set.patch_count(), "patch", "patches"));
    if (Status status = check_face_corners("triangle", mesh.indices, 3, mesh.vertex_count()); !status.ok())
      return status;
    if (Status status = check_face_corners("quad", mesh.quads, 4, mesh.vertex_count()); !status.ok()) return status;
    RangeList ranges(mesh, set, bounds);
    (void)for_faces_by_patch(mesh, [&](std::uint32_t patch, bool is_quad, std::size_t t, std::size_t q) {
      ranges.add(patch, is_quad, t, q);
      return Status();
    });
    return std::move(ranges).take();
  });
}

Result<std::vector<std::uint16_t>> short_indices(const Mesh& mesh) {
  return guarded([&]() -> Result<std::vector<std::uint16_t>> {
    constexpr std::size_t most = std::size_t{1} << 16;
    if (mesh.vertex_count() > most)
      return Status(StatusCode::unsupported, "the mesh has " + counted(mesh.vertex_count(), "vertex", "vertices") +
                                                 ", indices of 16 bits have room for " + std::to_string(most));
    if (Status status = check_face_corners("triangle", mesh.indices, 3, mesh.vertex_count()); !status.ok())
      return status;
    std::vector<std::uint16_t> indices(mesh.indices.size());
    std::ranges::transform(mesh.indices, indices.begin(),
                           [](std::uint32_t k) { return static_cast<std::uint16_t>(k); });
    return indices;
  });
}

}}  // namespace tessera::abi_0_1
