#include "ray/leaf/leaf_trims.h"

#include <algorithm>
#include <optional>

#include "parallel/parallel_for.h"
#include "trim/trim_region_impl.h"

namespace tessera::inline abi_0_1 {
namespace {

constexpr std::size_t leaves_per_task = 64;

/// A leaf's rectangle in the parameters of its surface.
Domain rectangle_of(const Domain& patch, const Leaf& leaf) {
  return {patch.u_at(leaf.u0), patch.u_at(leaf.u0 + leaf.du), patch.v_at(leaf.v0), patch.v_at(leaf.v0 + leaf.dv)};
}

/// Whether a piece may pass through a rectangle: by its box, and what it may be off.
bool may_meet(const TrimPiece& piece, const Domain& box) {
  const ParameterPoint off = {2 * piece.error.u + 1e-9 * (box.u1 - box.u0),
                              2 * piece.error.v + 1e-9 * (box.v1 - box.v0)};
  return piece.lower_u() - off.u <= box.u1 && piece.upper_u() + off.u >= box.u0 && piece.lower_v() - off.v <= box.v1 &&
         piece.upper_v() + off.v >= box.v0;
}

}  // namespace

Status LeafTrims::build(const SetView& set, std::span<const Leaf> leaves, const Execution& execution) {
  set_ = &set.impl();
  trims_ = set.impl().trims;
  if (!trims_) return {};
  const Execution quiet{.cancel = execution.cancel};
  std::vector<std::optional<TrimRegion>> made(trims_->regions.size());
  const auto locate_points = [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) made[k].emplace(TrimRegion::Impl::for_points(trims_->regions[k]));
  };
  if (Status status = parallel_for(made.size(), 1, quiet, locate_points); !status.ok()) return status;
  regions_.clear();
  for (std::optional<TrimRegion>& region : made) regions_.push_back(*std::move(region));
  regions_of_.assign(set.patch_count(), std::uint32_t{no_id});
  for (const PatchTrims::Cut& cut : trims_->cuts) regions_of_[cut.patch] = cut.region;
  uses_.resize(leaves.size());
  const auto find_uses = [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) uses_[k] = use_of(set, leaves[k]);
  };
  return parallel_for(leaves.size(), leaves_per_task, quiet, find_uses);
}

std::uint8_t LeafTrims::use_of(const SetView& set, const Leaf& leaf) const {
  const auto number = [](PatchUse use) { return static_cast<std::uint8_t>(use); };
  if (!trims_->is_cut[leaf.patch]) return number(PatchUse::whole);
  const TrimRegion& region = regions_[regions_of_[leaf.patch]];
  const TrimRegion::Impl& impl = impl_of(region);
  const auto cut = std::ranges::lower_bound(trims_->cuts, leaf.patch, {}, &PatchTrims::Cut::patch);
  const Domain box = rectangle_of(set.source(leaf.patch).domain, leaf);
  for (const std::uint32_t piece : impl.pieces_of(cut->place))
    if (may_meet(impl.pieces[piece], box)) return number(PatchUse::cut);
  switch (region.locate((box.u0 + box.u1) / 2, (box.v0 + box.v1) / 2)) {
    case TrimSide::inside:
      return number(PatchUse::whole);
    case TrimSide::outside:
      return number(PatchUse::out);
    default:
      return number(PatchUse::cut);
  }
}

// The root may lie anywhere in a rectangle about it. A loop that passes through has corners on both sides of it, unless
// it turns back inside: then it is as near as rounding.
TrimSide LeafTrims::side_of(const LeafRoot& root) const {
  const Domain& domain = set_->sources[root.patch].domain;
  const TrimRegion& region = regions_[regions_of_[root.patch]];
  const double off = root.residual + root.noise;
  const double du = std::min(reach_u(root, off), 1.0), dv = std::min(reach_v(root, off), 1.0);
  const double us[] = {std::max(root.u - du, 0.0), std::min(root.u + du, 1.0)};
  const double vs[] = {std::max(root.v - dv, 0.0), std::min(root.v + dv, 1.0)};
  const TrimSide side = region.locate(domain.u_at(root.u), domain.v_at(root.v));
  for (const double u : us)
    for (const double v : vs)
      if (region.locate(domain.u_at(u), domain.v_at(v)) != side) return TrimSide::border;
  return side;
}

}  // namespace tessera::inline abi_0_1
