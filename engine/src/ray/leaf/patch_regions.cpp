#include "ray/leaf/patch_regions.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "base/impl_access.h"
#include "parallel/parallel_for.h"
#include "trim/trim_region_impl.h"

namespace tessera { inline namespace abi_0_1 {

Status PatchRegions::build(const SetView& set, const Execution& execution) {
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
  std::vector<std::uint32_t> of_surfaces(set.impl().surface_count, no_id);
  for (const PatchTrims::Cut& cut : trims_->cuts) of_surfaces[set.source(cut.patch).surface] = cut.region;
  regions_of_.clear();
  for (std::size_t patch = 0; patch < set.patch_count(); ++patch)
    regions_of_.push_back(of_surfaces[set.source(patch).surface]);
  return {};
}

std::span<const std::uint32_t> PatchRegions::pieces_of(std::uint32_t patch) const {
  const auto cut = std::ranges::lower_bound(trims_->cuts, patch, {}, &PatchTrims::Cut::patch);
  return impl_of(of(patch)).pieces_of(cut->place);
}

std::size_t PatchRegions::memory_bytes() const {
  std::size_t bytes = regions_of_.capacity() * sizeof(std::uint32_t);
  for (const TrimRegion& region : regions_)
    bytes += impl_of(region).cells.memory_bytes() + impl_of(region).pieces.capacity() * sizeof(TrimPiece);
  return bytes;
}

}}  // namespace tessera::abi_0_1
