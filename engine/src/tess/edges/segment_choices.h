#pragma once
// Holds the segments that a patch may have, and chooses those that suit its neighbours.

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "tess/cells/segments.h"
#include "tess/edges/shared_edges.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// Segments, and the distance that a patch keeps with them.
struct ProvenSegments {
  PatchSegments segments;
  double distance = 0;
  /// The distance holds wherever triangles lie; if false, only if none crosses a middle that segments part.
  bool anywhere = false;
};

/// The proven segments of a patch with the fewest cells, in the order of their cells.
class SegmentChoices {
 public:
  static constexpr std::size_t most = 8;

  explicit SegmentChoices(const ProvenSegments& first = {}) : all_{first} {}
  std::size_t count() const { return count_; }
  const ProvenSegments& operator[](std::size_t k) const { return all_[k]; }
  const ProvenSegments& fewest() const { return all_.front(); }
  /// Returns the number of cells beyond which a choice saves nothing for neighbours.
  double max_cells() const { return 1.25 * fewest().segments.cells() + 2; }
  bool has_room_for(PatchSegments segments) const {
    return segments.cells() <= max_cells() && (count_ < most || segments.cells() < all_[count_ - 1].segments.cells());
  }
  /// Adds a choice if there is room, behind those of as many cells; the last one is dropped if there are too many. Of
  /// equal segments, those proven anywhere are kept.
  void add(const ProvenSegments& choice) {
    if (!has_room_for(choice.segments)) return;
    for (std::size_t k = 0; k < count_; ++k)
      if (all_[k].segments == choice.segments) {
        if (choice.anywhere) all_[k] = choice;
        return;
      }
    count_ = std::min(count_ + 1, most);
    std::size_t k = count_ - 1;
    for (; k > 0 && choice.segments.cells() < all_[k - 1].segments.cells(); --k) all_[k] = all_[k - 1];
    all_[k] = choice;
  }

 private:
  std::array<ProvenSegments, most> all_;
  std::size_t count_ = 1;
};

/// Returns the choice for each patch with which the mesh has about the fewest triangles, including borders and strips,
/// and about no more than with the first choices.
///
/// One patch after the other takes the best choice for itself and its borders while the others are unchanged; this is
/// done four times. `against`: for each border, whether it runs against its edge. Errors: cancelled.
Result<std::vector<std::uint8_t>> choose_together(std::span<const PatchShape> shapes, const SharedEdges& edges,
                                                  std::span<const std::uint8_t> against,
                                                  std::span<const SegmentChoices> choices,
                                                  const std::atomic<bool>* cancel = nullptr);

}}  // namespace tessera::abi_0_1
