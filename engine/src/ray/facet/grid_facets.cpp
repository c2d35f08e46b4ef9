// Facets of grids that are evaluated for a ray scene.

#include <algorithm>

#include "base/aligned.h"
#include "eval/uniform_grid.h"
#include "ray/facet/facet_deviation.h"
#include "ray/facet/facet_source.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr std::size_t padding = 1;  // floats after the last vertex, which Embree reads as 16 bytes

class GridFacets final : public FacetSource {
 public:
  GridFacets(UniformGrid grid, int rate) : grid_(std::move(grid)), rate_(rate) {}

  Status build(const SetView& set, FacetTree& tree, const Execution& execution) override {
    GridVertices vertices{nullptr, set.patch_count(), rate_ + 1, rate_ + 1};
    if (Status status = FacetTree::check_size(vertices); !status.ok()) return status;
    positions_.resize(3 * grid_.capacity() + padding);
    const auto view = View3<float>::interleaved(std::span(positions_).first(3 * grid_.capacity()));
    Status status =
        grid_.run(set.impl(), QuantityViews<float>{.position = view, .du = {}, .dv = {}, .normal = {}}, execution);
    if (!status.ok()) return status;
    vertices.data = positions_.data();
    return tree.build(vertices, execution);
  }
  double deviation(const SetView& set) const override {
    double most = 0;
    for (std::size_t k = 0; k < set.patch_count(); ++k)
      most = std::max(most, facet_deviation(set.patch(k), largest_cell(), largest_cell()));
    return most;
  }
  double largest_cell() const override { return 1.0 / rate_; }
  FacetHit located(const FacetHit& hit) const override {
    return {hit.grid, hit.t, std::clamp(hit.u, 0.0f, 1.0f), std::clamp(hit.v, 0.0f, 1.0f)};
  }
  std::size_t memory_bytes() const override { return positions_.capacity() * sizeof(float); }

 private:
  UniformGrid grid_;
  int rate_;
  AlignedVector<float> positions_;  // `[patch][iu][iv]`
};

}  // namespace

Result<std::unique_ptr<FacetSource>> grid_facets(const PatchSet& set, int rate, std::optional<Isa> isa) {
  Result<UniformGrid> grid = UniformGrid::make(set, rate, rate, isa);
  if (!grid) return grid.status();
  return std::unique_ptr<FacetSource>(std::make_unique<GridFacets>(*std::move(grid), rate));
}

}}  // namespace tessera::abi_0_1
