#pragma once
// Segments that a patch may have, and which of them suit its neighbours.

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "tess/edges/shared_edges.h"
#include "tess/plan/segments.h"
#include "tessera/status.h"

namespace tessera::inline abi_0_1 {

/// Segments, and the distance that a patch keeps with them.
struct ProvenSegments {
  PatchSegments segments;
  double distance = 0;
  bool anywhere = false;  ///< wherever triangles lie; else if none straddles a middle that segments part
};

/// Those with the fewest cells, fewest first.
class SegmentChoices {
 public:
  static constexpr std::size_t most = 8;

  explicit SegmentChoices(const ProvenSegments& first = {}) : all_{first} {}
  std::size_t count() const { return count_; }
  const ProvenSegments& operator[](std::size_t k) const { return all_[k]; }
  const ProvenSegments& fewest() const { return all_.front(); }
  /// Cells beyond which a choice saves nothing elsewhere.
  double max_cells() const { return 1.25 * fewest().segments.cells() + 2; }
  bool has_room_for(PatchSegments segments) const {
    return segments.cells() <= max_cells() && (count_ < most || segments.cells() < all_[count_ - 1].segments.cells());
  }
  /// If there is room. Behind those of as many cells; the last gives way. Of the same segments those proven anywhere stay.
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

/// Which choice of each patch it takes: with these the mesh has about the fewest triangles, borders and strips counted, and
/// about no more than with the first. One patch after the other takes the best for it and its borders, the others' being as
/// they are, four times over. `against`: of each border, whether it runs against its edge. Errors: cancelled.
Result<std::vector<std::uint8_t>> choose_together(std::span<const PatchShape> shapes, const SharedEdges& edges,
                                                  std::span<const std::uint8_t> against,
                                                  std::span<const SegmentChoices> choices,
                                                  const std::atomic<bool>* cancel = nullptr);

}  // namespace tessera::inline abi_0_1
