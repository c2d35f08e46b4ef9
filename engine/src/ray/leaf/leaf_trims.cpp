#include "ray/leaf/leaf_trims.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "parallel/parallel_for.h"
#include "ray/leaf/kept_part.h"
#include "trim/trim_region_impl.h"

namespace tessera::inline abi_0_1 {
namespace {

constexpr std::size_t leaves_per_task = 64;
constexpr double shares = 1024;          // of a leaf's side; a leaf shrinks to a few of them
constexpr int max_shrinks = 2;           // each to 1/1024 of a side at most: the ends stay exact numbers
constexpr double max_needle = 16;        // by which a shrunk leaf may be longer along one side than the leaf was
constexpr double worth_shrinking = 0.8;  // share of the area

/// A leaf's side along u or v, in the patch's parameter.
struct LeafSide {
  double start, width;
};

/// A leaf's rectangle in the parameters of its surface.
Domain rectangle_of(const Domain& patch, const Leaf& leaf) {
  return {patch.u_at(leaf.u0), patch.u_at(leaf.u0 + leaf.du), patch.v_at(leaf.v0), patch.v_at(leaf.v0 + leaf.dv)};
}

/// Returns a part of a leaf's side that holds a range of the patch's parameter, with a margin of a quarter of a share. Its
/// ends are even shares of the side, so that no sum rounds.
LeafSide shrunk(const LeafSide& side, double from, double to) {
  const auto share = [&](double x) { return shares * ((x - side.start) / side.width); };
  const double lower = std::clamp(std::floor(share(from) - 0.25), 0.0, shares - 1);
  const double upper = std::clamp(std::ceil(share(to) + 0.25), lower + 1, shares);
  return {side.start + lower / shares * side.width, (upper - lower) / shares * side.width};
}

/// Returns a side that is at least `width` wide, within the side that it is a part of.
LeafSide widened(LeafSide side, double width, const LeafSide& within) {
  while (side.width < width) {
    side.start = std::max(side.start - side.width, within.start);
    side.width = std::min(4 * side.width, within.start + within.width - side.start);
  }
  return side;
}

/// Shrinks a leaf to what is kept of it, but not to a needle. Returns whether that pays.
bool shrink(Leaf& leaf, const Domain& patch, const Domain& kept) {
  const LeafSide along_u{leaf.u0, leaf.du}, along_v{leaf.v0, leaf.dv};
  LeafSide u = shrunk(along_u, patch.local_u(kept.u0), patch.local_u(kept.u1));
  LeafSide v = shrunk(along_v, patch.local_v(kept.v0), patch.local_v(kept.v1));
  u = widened(u, v.width / leaf.dv * leaf.du / max_needle, along_u);
  v = widened(v, u.width / leaf.du * leaf.dv / max_needle, along_v);
  if (u.width * v.width > worth_shrinking * leaf.du * leaf.dv) return false;
  leaf.u0 = u.start, leaf.du = u.width, leaf.v0 = v.start, leaf.dv = v.width;
  leaf.is_shrunk = true;
  return true;
}

}  // namespace

Status LeafTrims::build(const SetView& set, std::span<Leaf> leaves, const Execution& execution) {
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

std::uint8_t LeafTrims::use_of(const SetView& set, Leaf& leaf) const {
  const auto number = [](PatchUse use) { return static_cast<std::uint8_t>(use); };
  if (!trims_->is_cut[leaf.patch]) return number(PatchUse::whole);
  const TrimRegion& region = regions_[regions_of_[leaf.patch]];
  const auto cut = std::ranges::lower_bound(trims_->cuts, leaf.patch, {}, &PatchTrims::Cut::patch);
  const std::span<const std::uint32_t> pieces = impl_of(region).pieces_of(cut->place);
  const Domain& patch = set.source(leaf.patch).domain;
  KeptPart kept = kept_part(region, pieces, rectangle_of(patch, leaf));
  for (int k = 0; k < max_shrinks && kept.use == PatchUse::cut && shrink(leaf, patch, kept.hull); ++k)
    kept = kept_part(region, pieces, rectangle_of(patch, leaf));
  return number(kept.use);
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
