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

/// Collects the ranges of the faces of one surface after the other.
class RangeList {
 public:
  RangeList(const Mesh& mesh, const PatchSet& set, std::span<const float> bounds)
      : mesh_(mesh), set_(set), bounds_(bounds) {}

  void add(const FaceRun& run) {
    const std::uint32_t surface = set_.source(run.patch).surface;
    if (ranges_.empty() || ranges_.back().surface != surface) {
      end();
      MeshRange& next = ranges_.emplace_back();
      next.surface = surface, next.first_triangle = run.first_triangle, next.first_quad = run.first_quad;
      lowest_ = std::numeric_limits<std::size_t>::max(), highest_ = 0;
    }
    MeshRange& range = ranges_.back();
    (run.is_quads ? range.quad_count : range.triangle_count) += run.count;
    range.bound =
        std::max(range.bound, bounds_.empty() ? std::numeric_limits<double>::infinity() : double(bounds_[run.patch]));
    const auto corners = run.is_quads ? std::span(mesh_.quads).subspan(4 * run.first_quad, 4 * run.count)
                                      : std::span(mesh_.indices).subspan(3 * run.first_triangle, 3 * run.count);
    for (const std::uint32_t corner : corners) {
      lowest_ = std::min<std::size_t>(lowest_, corner);
      highest_ = std::max<std::size_t>(highest_, corner);
      range.box.extend(vertex_of(mesh_, corner));
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
    (void)for_faces_by_patch(mesh, [&](const FaceRun& run) {
      ranges.add(run);
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
