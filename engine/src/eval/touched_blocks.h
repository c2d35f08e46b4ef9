#pragma once
// Edits sorted by the blocks of a set: an update does this before it writes.

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "base/text.h"
#include "block/patch_set_impl.h"
#include "tessera/evaluate.h"

namespace tessera { inline namespace abi_0_1 {

/// Returns the status of an edit that cannot be made.
inline Status edit_error(StatusCode code, std::size_t edit, const std::string& why) {
  return Status(code, "edit " + std::to_string(edit) + ": " + why, static_cast<std::ptrdiff_t>(edit));
}

/// The edits of one call, block by block. Holds memory for all patches of a set, so that no call allocates.
class TouchedBlocks {
 public:
  explicit TouchedBlocks(const PatchSet::Impl& set)
      : edits_(set.lane_patches.size(), no_id), counts_(set.lane_counts.size(), 0) {
    blocks_.reserve(counts_.size());
    first_points_.reserve(set.patches.size());
  }

  /// Takes the edits of a call. Errors: invalid_argument (no such patch, one named twice), count_mismatch; there are
  /// then no edits, as after clear().
  Status add(const PatchSet::Impl& set, const PatchEdits& edits) {
    clear();
    std::size_t next = 0;
    for (std::size_t k = 0; k < edits.patch.size(); ++k) {
      const std::uint32_t patch = edits.patch[k];
      if (patch >= set.patches.size())
        return cleared(edit_error(
            StatusCode::invalid_argument, k,
            "there is no patch " + std::to_string(patch) + " in a set of " + std::to_string(set.patches.size())));
      const PatchSet::Slot slot = set.slots[patch];
      std::uint32_t& edit = edits_[slot.block * lanes + slot.lane];
      if (edit != no_id)
        return cleared(edit_error(StatusCode::invalid_argument, k,
                                  "patch " + std::to_string(patch) + " has edit " + std::to_string(edit) + " already"));
      edit = static_cast<std::uint32_t>(k);
      if (counts_[slot.block]++ == 0) blocks_.push_back(slot.block);
      first_points_.push_back(next);
      next += set.patches[patch].points().size();
    }
    if (next == edits.points.size()) return {};
    return cleared(Status(StatusCode::count_mismatch, counted(edits.patch.size(), "edit") + " must bring " +
                                                          counted(next, "control point") + ", found " +
                                                          std::to_string(edits.points.size())));
  }

  void clear() {
    for (const std::uint32_t block : blocks_) {
      std::fill_n(edits_.begin() + static_cast<std::ptrdiff_t>(block * lanes), lanes, no_id);
      counts_[block] = 0;
    }
    blocks_.clear();
    first_points_.clear();
  }

  std::size_t block_count() const { return counts_.size(); }                                ///< blocks of the set
  std::span<const std::uint32_t> blocks() const { return blocks_; }                         ///< blocks with edits
  int count(std::uint32_t block) const { return counts_[block]; }                           ///< edits of the block
  const std::uint32_t* edits(std::uint32_t block) const { return &edits_[block * lanes]; }  ///< by lane; or none
  std::size_t first_point(std::size_t edit) const { return first_points_[edit]; }

 private:
  static constexpr std::size_t lanes = PatchSet::lanes;

  Status cleared(Status status) {
    clear();
    return status;
  }

  std::vector<std::uint32_t> edits_;  ///< `[block][lane]`
  std::vector<std::uint8_t> counts_;  ///< `[block]`: its edits
  std::vector<std::uint32_t> blocks_;
  std::vector<std::size_t> first_points_;  ///< `[edit]`
};

}}  // namespace tessera::abi_0_1
