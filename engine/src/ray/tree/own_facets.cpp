// Facets in the library's own tree: a leaf is a triangle, a quad, or a block of two by two cells of a grid. Quads and
// cells are two triangles each.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "kernel/table/kernel_table.h"
#include "ray/line/ray_line.h"
#include "ray/tree/box_nodes.h"
#include "ray/tree/facet_shear.h"
#include "ray/tree/own_trees.h"
#include "ray/tree/tree_walk.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// A place on a facet. Along: from its first corner to its second; across: to its last.
struct FacetPlace {
  std::uint32_t leaf = FacetHit::nothing, cell = 0;
  double t = 0, along = 0, across = 0;
};

/// Takes a place if it is nearer. Of places at one t, that of the first facet counts, whichever is met first.
void take_nearer(const FacetPlace& met, FacetPlace& nearest) {
  const bool first = met.leaf != nearest.leaf ? met.leaf < nearest.leaf : met.cell < nearest.cell;
  if (nearest.leaf == FacetHit::nothing || met.t < nearest.t || (met.t == nearest.t && first)) nearest = met;
}

/// Both triangles share the diagonal from the second corner to the last.
void meet_quad(const FacetShear& shear, const std::array<const ShearedPoint*, 4>& corner, FacetPlace at,
               FacetPlace& nearest) {
  if (const auto hit = shear.meet(*corner[0], *corner[1], *corner[3])) {
    at.t = hit->t, at.along = hit->second, at.across = hit->third;
    take_nearer(at, nearest);
  }
  if (const auto hit = shear.meet(*corner[2], *corner[3], *corner[1])) {
    at.t = hit->t, at.along = 1 - hit->second, at.across = 1 - hit->third;
    take_nearer(at, nearest);
  }
}

/// The blocks of grids, row by row.
class GridBlocks {
 public:
  static constexpr std::uint32_t side = 2;  // cells

  GridBlocks() = default;
  explicit GridBlocks(const GridVertices& grids)
      : data_(grids.data),
        height_(static_cast<std::uint32_t>(grids.height)),
        width_(static_cast<std::uint32_t>(grids.width)),
        columns_((width_ - 1 + side - 1) / side),
        per_grid_(std::size_t{(height_ - 1 + side - 1) / side} * columns_),
        size_(grids.grids * per_grid_) {}

  std::size_t size() const { return size_; }
  Box3 box(std::size_t leaf) const {
    Box3 box;
    const Block block = at(leaf);
    for (std::uint32_t i = 0; i <= block.rows; ++i)
      for (std::uint32_t j = 0; j <= block.columns; ++j) {
        const float* const p = block.vertex + 3 * (std::size_t{i} * width_ + j);
        box.extend(Vec3{double{p[0]}, double{p[1]}, double{p[2]}});
      }
    return box;
  }
  void meet(std::uint32_t leaf, const FacetShear& shear, FacetPlace& nearest) const {
    const Block block = at(leaf);
    ShearedPoint point[side + 1][side + 1];
    for (std::uint32_t i = 0; i <= block.rows; ++i)
      for (std::uint32_t j = 0; j <= block.columns; ++j)
        point[i][j] = shear(block.vertex + 3 * (std::size_t{i} * width_ + j));
    for (std::uint32_t i = 0; i < block.rows; ++i)
      for (std::uint32_t j = 0; j < block.columns; ++j)
        meet_quad(shear, {&point[i][j], &point[i][j + 1], &point[i + 1][j + 1], &point[i + 1][j]},
                  {.leaf = leaf, .cell = side * i + j}, nearest);
  }
  FacetHit hit_at(const FacetPlace& place) const {
    const Block block = at(place.leaf);
    const auto share = [](std::uint32_t first, double in, std::uint32_t vertices) {
      return static_cast<float>((first + in) / (vertices - 1));
    };
    return {static_cast<std::uint32_t>(place.leaf / per_grid_), static_cast<float>(place.t),
            share(block.row + place.cell / side, place.across, height_),
            share(block.column + place.cell % side, place.along, width_)};
  }

 private:
  struct Block {
    std::uint32_t row, column;    ///< of its first cell
    std::uint32_t rows, columns;  ///< number of cells
    const float* vertex;          ///< the first one
  };
  Block at(std::size_t leaf) const {
    const auto within = static_cast<std::uint32_t>(leaf % per_grid_);
    const std::uint32_t row = within / columns_ * side, column = within % columns_ * side;
    const std::size_t first = leaf / per_grid_ * height_ * width_ + std::size_t{row} * width_ + column;
    return {row, column, std::min(side, height_ - 1 - row), std::min(side, width_ - 1 - column), data_ + 3 * first};
  }

  const float* data_ = nullptr;
  std::uint32_t height_ = 0, width_ = 0, columns_ = 0;
  std::size_t per_grid_ = 1, size_ = 0;
};

/// Triangles, and then quads.
class Polygons {
 public:
  Polygons() = default;
  explicit Polygons(const FacetVertices& facets) : facets_(facets), triangles_(facets.triangles.size() / 3) {}

  std::size_t size() const { return triangles_ + facets_.quads.size() / 4; }
  Box3 box(std::size_t leaf) const {
    Box3 box;
    for (std::size_t k = 0; k < corner_count(leaf); ++k) {
      const float* const p = corner(leaf, k);
      box.extend(Vec3{double{p[0]}, double{p[1]}, double{p[2]}});
    }
    return box;
  }
  void meet(std::uint32_t leaf, const FacetShear& shear, FacetPlace& nearest) const {
    std::array<ShearedPoint, 4> at;
    for (std::size_t k = 0; k < corner_count(leaf); ++k) at[k] = shear(corner(leaf, k));
    if (leaf >= triangles_) return meet_quad(shear, {&at[0], &at[1], &at[2], &at[3]}, {.leaf = leaf}, nearest);
    if (const auto hit = shear.meet(at[0], at[1], at[2]))
      take_nearer({.leaf = leaf, .t = hit->t, .along = hit->second, .across = hit->third}, nearest);
  }
  static FacetHit hit_at(const FacetPlace& place) {
    return {place.leaf, static_cast<float>(place.t), static_cast<float>(place.across), static_cast<float>(place.along)};
  }

 private:
  std::size_t corner_count(std::size_t leaf) const { return leaf < triangles_ ? 3 : 4; }
  const float* corner(std::size_t leaf, std::size_t k) const {
    const std::uint32_t index =
        leaf < triangles_ ? facets_.triangles[3 * leaf + k] : facets_.quads[4 * (leaf - triangles_) + k];
    return facets_.data + 3 * std::size_t{index};
  }

  FacetVertices facets_;
  std::size_t triangles_ = 0;
};

/// The ray as a line in the frame. Its start is the point nearest to the middle of the frame, as that of a RayLine.
struct FacetLine {
  RayLine line;
  double per_t = 1, before = 0;  ///< s = per_t t - before

  FacetLine(const FacetRay& ray, const SceneFrame& frame) {
    const Vec3 origin = frame.to_scene({double{ray.origin[0]}, double{ray.origin[1]}, double{ray.origin[2]}});
    const Vec3 direction{double{ray.direction[0]}, double{ray.direction[1]}, double{ray.direction[2]}};
    line.direction = normalized(direction);
    per_t = length(direction) * frame.scale;
    before = -dot(origin, line.direction);
    line.start = origin + before * line.direction;
    constexpr double reach = 2;  // beyond the half diagonal of the frame's box
    line.enter = std::max(per_t * double{ray.tnear} - before, -reach);
    line.leave = std::min(per_t * double{ray.tfar} - before, reach);
    line.empty = !(line.enter <= line.leave && dot(line.start, line.start) <= reach * reach);
  }
};

/// The tree over facets of one kind.
template <class Facets>
class FacetNodes {
 public:
  Status build(const Facets& facets, const Execution& execution);
  /// Returns the nearest place, or any.
  FacetPlace trace(const FacetRay& ray, bool any, const kernel::RayKernels& kernels) const;
  FacetHit hit_at(const FacetPlace& place) const { return facets_.hit_at(place); }
  Box3 box() const { return box_; }
  std::size_t memory_bytes() const { return nodes_.memory_bytes(); }

 private:
  Facets facets_;
  BoxNodes nodes_;  // in the frame
  SceneFrame frame_;
  Box3 box_;
};

template <class Facets>
Status FacetNodes<Facets>::build(const Facets& facets, const Execution& execution) {
  if (facets.size() > BoxNodes::max_boxes)
    return Status(StatusCode::unsupported, "more than the 2^31 - 2 facets of one ray scene without Embree");
  if (facets.size() == 0) return {};
  Box3 all;
  for (std::size_t k = 0; k < facets.size(); ++k) {
    const Box3 box = facets.box(k);
    all.extend(box.lower), all.extend(box.upper);
  }
  const double size = all.diagonal();
  frame_ = size > 0 && size <= double{std::numeric_limits<float>::max()} ? SceneFrame::around(all)
                                                                         : SceneFrame{all.lower, 1};
  Status status = nodes_.build(
      facets.size(),
      [&](std::size_t k) {
        const Box3 box = facets.box(k);
        return Box3{frame_.to_scene(box.lower), frame_.to_scene(box.upper)};
      },
      execution);
  if (status.ok()) facets_ = facets, box_ = all;
  return status;
}

template <class Facets>
FacetPlace FacetNodes<Facets>::trace(const FacetRay& ray, bool any, const kernel::RayKernels& kernels) const {
  FacetPlace nearest;
  const FacetLine along(ray, frame_);
  if (along.line.empty) return nearest;
  const FacetShear shear(ray);
  kernel::TreeWalk walk;
  start_walk(along.line, nodes_, walk);
  for (;;) {
    const std::uint32_t leaf = kernels.next_leaf(nodes_.nodes(), walk);
    if (leaf == kernel::TreeNode::none) return nearest;
    facets_.meet(leaf, shear, nearest);
    if (nearest.leaf == FacetHit::nothing) continue;
    if (any) return nearest;
    walk.far = std::min(walk.far, far_of_walk(along.per_t * nearest.t - along.before));
  }
}

class OwnFacets final : public FacetTree {
 public:
  explicit OwnFacets(const kernel::RayKernels& kernels) : kernels_(kernels) {}

  Status build(const GridVertices& vertices, const Execution& execution) override {
    clear();
    if (Status status = check_size(vertices); !status.ok()) return status;
    has_grids_ = true;
    return vertices.height < 2 || vertices.width < 2 ? Status() : grids_.build(GridBlocks(vertices), execution);
  }
  Status build(const FacetVertices& facets, const Execution& execution) override {
    clear();
    return polygons_.build(Polygons(facets), execution);
  }

  FacetHit closest(const FacetRay& ray) const override {
    const FacetPlace place = trace(ray, false);
    if (place.leaf == FacetHit::nothing) return {};
    return has_grids_ ? grids_.hit_at(place) : polygons_.hit_at(place);
  }
  bool occluded(const FacetRay& ray) const override { return trace(ray, true).leaf != FacetHit::nothing; }
  void closest(std::span<const FacetRay> rays, std::span<FacetHit> hits) const override {
    for (std::size_t k = 0; k < rays.size(); ++k) hits[k] = closest(rays[k]);
  }
  void occluded(std::span<const FacetRay> rays, std::span<std::uint8_t> occluded) const override {
    for (std::size_t k = 0; k < rays.size(); ++k) occluded[k] = this->occluded(rays[k]);
  }

  Box3 box() const override { return has_grids_ ? grids_.box() : polygons_.box(); }
  std::size_t memory_bytes() const override { return grids_.memory_bytes() + polygons_.memory_bytes(); }

 private:
  void clear() { grids_ = {}, polygons_ = {}, has_grids_ = false; }
  FacetPlace trace(const FacetRay& ray, bool any) const {
    return has_grids_ ? grids_.trace(ray, any, kernels_) : polygons_.trace(ray, any, kernels_);
  }

  const kernel::RayKernels& kernels_;
  bool has_grids_ = false;
  FacetNodes<GridBlocks> grids_;
  FacetNodes<Polygons> polygons_;
};

}  // namespace

Result<std::unique_ptr<FacetTree>> make_own_facets(Isa isa) {
  return std::unique_ptr<FacetTree>(std::make_unique<OwnFacets>(ray_kernels(isa)));
}

}}  // namespace tessera::abi_0_1
