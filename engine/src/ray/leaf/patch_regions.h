#pragma once
// The regions that the loops of a set's faces keep, by patch.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "block/patch_trims.h"
#include "ray/line/set_view.h"
#include "tessera/execution.h"
#include "tessera/status.h"
#include "tessera/trim_region.h"

namespace tessera { inline namespace abi_0_1 {

/// Const calls from any number of threads.
class PatchRegions {
 public:
  /// Makes the regions of a set, whose patches may then be edited. Errors: cancelled, out_of_memory.
  Status build(const SetView& set, const Execution& execution);
  /// Whether any patch is cut; otherwise no other call is allowed.
  bool any() const { return trims_ != nullptr; }
  bool is_cut(std::uint32_t patch) const { return trims_->is_cut[patch]; }
  /// Whether the face of the patch has a cut patch.
  bool has_region(std::uint32_t patch) const { return regions_of_[patch] != no_id; }
  /// The region of a face with a cut patch, in the parameters of its surface. It locates points.
  const TrimRegion& of(std::uint32_t patch) const { return regions_[regions_of_[patch]]; }
  /// The pieces of that region that cut the patch.
  std::span<const std::uint32_t> pieces_of(std::uint32_t patch) const;
  /// The side of a point of a patch, which may be whole.
  TrimSide side_of(std::uint32_t patch, const Domain& domain, double u, double v) const {
    return is_cut(patch) ? of(patch).locate(domain.u_at(u), domain.v_at(v)) : TrimSide::inside;
  }
  /// Counts the cells and pieces of the regions, which no one else holds.
  std::size_t memory_bytes() const;

 private:
  std::shared_ptr<const PatchTrims> trims_;
  std::vector<TrimRegion> regions_;        ///< as those of `trims_`, and they locate points
  std::vector<std::uint32_t> regions_of_;  ///< `[patch]`: into `regions_`, or no_id
};

}}  // namespace tessera::abi_0_1
