// Facets of a mesh that was made for other purposes, such as one that keeps a tolerance.

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "base/text.h"
#include "ray/facet/facet_deviation.h"
#include "ray/facet/facet_source.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

Status invalid(std::string message, std::size_t index) {
  return {StatusCode::invalid_argument, std::move(message), static_cast<std::ptrdiff_t>(index)};
}

class MeshFacets final : public FacetSource {
 public:
  explicit MeshFacets(const Mesh& mesh) : mesh_(mesh) {}

  Status build(const SetView& set, FacetTree& tree, const Execution& execution) override {
    if (Status status = check(set); !status.ok()) return status;
    measure_cells(set);
    // Embree reads the last vertex as 16 bytes.
    const bool has_room = mesh_.positions.capacity() > mesh_.positions.size();
    copy_.clear();
    if (!has_room) {
      copy_.reserve(mesh_.positions.size() + 1);
      copy_ = mesh_.positions;
    }
    const float* const positions = has_room ? mesh_.positions.data() : copy_.data();
    return tree.build(FacetVertices{positions, mesh_.vertex_count(), mesh_.indices, mesh_.quads}, execution);
  }
  double deviation(const SetView& set) const override {
    double most = 0;
    for (std::size_t k = 0; k < cells_.size(); ++k) {
      if (cells_[k].u > 0 || cells_[k].v > 0)
        most = std::max(most, facet_deviation(set.patch(k), cells_[k].u, cells_[k].v));
    }
    return most;
  }
  double largest_cell() const override {
    double most = 0;
    for (const Cell& cell : cells_) most = std::max({most, cell.u, cell.v});
    return most;
  }
  /// Embree's v runs along our u. Embree splits a quad into two triangles, with u and v from its first corner.
  FacetHit located(const FacetHit& hit) const override {
    const float along = hit.v, across = hit.u;
    const std::size_t triangles = mesh_.triangle_count();
    const bool is_quad = hit.grid >= triangles;
    const std::size_t face = is_quad ? hit.grid - triangles : hit.grid;
    const std::uint32_t* const corner = is_quad ? &mesh_.quads[4 * face] : &mesh_.indices[3 * face];
    std::array<float, 4> share{1 - along - across, along, across, 0};
    if (is_quad) share = {(1 - along) * (1 - across), along * (1 - across), along * across, (1 - along) * across};
    FacetHit out{is_quad ? mesh_.quad_patches[face] : mesh_.patches[face], hit.t, 0, 0};
    for (std::size_t k = 0; k < (is_quad ? 4u : 3u); ++k) {
      out.u += share[k] * mesh_.parameters[2 * corner[k]];
      out.v += share[k] * mesh_.parameters[2 * corner[k] + 1];
    }
    out.u = std::clamp(out.u, 0.0f, 1.0f), out.v = std::clamp(out.v, 0.0f, 1.0f);
    return out;
  }
  std::size_t memory_bytes() const override {
    return cells_.capacity() * sizeof(Cell) + copy_.capacity() * sizeof(float);
  }

 private:
  struct Cell {
    double u = 0, v = 0;
  };

  /// Calls face(corners, patch) for each face.
  template <class Face>
  void for_faces(const Face& face) const {
    for (std::size_t k = 0; k < mesh_.triangle_count(); ++k)
      face(std::span(mesh_.indices).subspan(3 * k, 3), mesh_.patches[k]);
    for (std::size_t k = 0; k < mesh_.quad_count(); ++k)
      face(std::span(mesh_.quads).subspan(4 * k, 4), mesh_.quad_patches[k]);
  }

  Status check(const SetView& set) const {
    Status status = check_vertices(set);
    return status.ok() ? check_faces(set) : status;
  }

  Status check_vertices(const SetView& set) const {
    const std::size_t vertices = mesh_.vertex_count();
    if (mesh_.positions.size() != 3 * vertices || mesh_.indices.size() % 3 != 0 || mesh_.quads.size() % 4 != 0)
      return invalid("the mesh holds " + counted(mesh_.positions.size(), "number") + " of positions, " +
                         counted(mesh_.indices.size(), "index", "indices") + " of triangles and " +
                         counted(mesh_.quads.size(), "index", "indices") +
                         " of quads, they must be multiples of 3, 3 and 4",
                     0);
    if (!mesh_.has_patches() || mesh_.parameters.size() != 2 * vertices)
      return invalid(
          "the mesh lacks the patch of each face or the parameters of each vertex: tessellate without shared "
          "vertices",
          0);
    if (!(mesh_.origin == set.origin()))
      return invalid("the mesh's origin is " + text(mesh_.origin) + ", the set's is " + text(set.origin()) +
                         ": tessellate this set",
                     0);
    for (std::size_t k = 0; k < mesh_.positions.size(); ++k) {
      if (!std::isfinite(mesh_.positions[k]))
        return {StatusCode::non_finite,
                "coordinate " + std::to_string(k % 3) + " of vertex " + std::to_string(k / 3) + " is " +
                    text(mesh_.positions[k]) + ", it must be finite",
                static_cast<std::ptrdiff_t>(k / 3)};
    }
    for (std::size_t k = 0; k < mesh_.parameters.size(); ++k) {
      if (!(mesh_.parameters[k] >= 0 && mesh_.parameters[k] <= 1))
        return {std::isfinite(mesh_.parameters[k]) ? StatusCode::invalid_argument : StatusCode::non_finite,
                std::string(k % 2 == 0 ? "u" : "v") + " of vertex " + std::to_string(k / 2) + " is " +
                    text(mesh_.parameters[k]) + ", it must be in [0, 1]",
                static_cast<std::ptrdiff_t>(k / 2)};
    }
    return {};
  }

  Status check_faces(const SetView& set) const {
    const std::size_t vertices = mesh_.vertex_count();
    Status status;
    std::size_t count = 0;
    for_faces([&](std::span<const std::uint32_t> corners, std::uint32_t patch) {
      if (status.ok() && patch >= set.patch_count())
        status = invalid("face " + std::to_string(count) + " names patch " + std::to_string(patch) + ", the set has " +
                             counted(set.patch_count(), "patch", "patches"),
                         count);
      for (const std::uint32_t corner : corners) {
        if (status.ok() && corner >= vertices)
          status = invalid("face " + std::to_string(count) + " has vertex " + std::to_string(corner) +
                               ", the mesh has " + counted(vertices, "vertex", "vertices"),
                           count);
      }
      ++count;
    });
    return status;
  }

  void measure_cells(const SetView& set) {
    cells_.assign(set.patch_count(), {});
    for_faces([&](std::span<const std::uint32_t> corners, std::uint32_t patch) {
      std::array<double, 2> low{1, 1}, high{0, 0};
      for (const std::uint32_t corner : corners) {
        for (std::size_t i = 0; i < 2; ++i) {
          const double x = mesh_.parameters[2 * corner + i];
          low[i] = std::min(low[i], x), high[i] = std::max(high[i], x);
        }
      }
      cells_[patch] = {std::max(cells_[patch].u, high[0] - low[0]), std::max(cells_[patch].v, high[1] - low[1])};
    });
  }

  const Mesh& mesh_;
  std::vector<Cell> cells_;  // the largest of each patch
  std::vector<float> copy_;  // of the positions, if there is no room after them
};

}  // namespace

std::unique_ptr<FacetSource> mesh_facets(const Mesh& mesh) { return std::make_unique<MeshFacets>(mesh); }

}}  // namespace tessera::abi_0_1
