#pragma once
// The vertices that a patch has along a side.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <ranges>
#include <span>

#include "tess/cells/stitched_patch.h"
#include "tess/trimmed/cut_patch.h"
#include "tess/trimmed/patch_sides.h"

namespace tessera { inline namespace abi_0_1 {

/// The vertices of a side by growing places along it. The patch's division or cut must outlive this object.
class SideVertices {
 public:
  /// A vertex, and the surface's parameter along the side.
  struct Place {
    double along;
    std::uint32_t vertex;
  };

  /// The side of a whole patch; one without an area has no vertices. `domain`: of the patch.
  SideVertices(const Division& division, const Domain& domain, Side side)
      : division_(&division),
        side_(side),
        from_(range_along(side, domain).first),
        to_(range_along(side, domain).second) {
    if (division.empty) return;
    segments_ = division.border[static_cast<std::size_t>(side)];
    size_ = static_cast<std::size_t>(segments_.rate()) + 1;
    ring_ = first_ = static_cast<std::uint32_t>(division.inner_count());
    ring_end_ = ring_ + static_cast<std::uint32_t>(division.ring_count());
    for (std::size_t before = 0; before < static_cast<std::size_t>(side); ++before)
      first_ += static_cast<std::uint32_t>(division.border[before].rate());
  }
  /// The side of a cut patch.
  SideVertices(const CutPatch& cut, Side side)
      : of_cut_(std::ranges::equal_range(cut.side_vertices, side, {}, &CutPatch::SideVertex::side)),
        size_(of_cut_.size()) {}

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  Place operator[](std::size_t k) const {
    if (!division_) return {of_cut_[k].along, of_cut_[k].vertex};
    const int at = static_cast<int>(k);
    const std::uint32_t vertex = first_ + static_cast<std::uint32_t>(is_backward(side_) ? segments_.rate() - at : at);
    return {line_at(from_, to_, segments_, at), vertex == ring_end_ ? ring_ : vertex};
  }
  /// Returns the number of vertices before a place, or up to and including it.
  std::size_t count_before(double along) const {
    return count([&](const Place& of) { return of.along < along; });
  }
  std::size_t count_up_to(double along) const {
    return count([&](const Place& of) { return of.along <= along; });
  }

 private:
  template <class IsBefore>
  std::size_t count(IsBefore is_before) const {
    return *std::ranges::partition_point(std::views::iota(std::size_t{0}, size_),
                                         [&](std::size_t k) { return is_before((*this)[k]); });
  }
  const Division* division_ = nullptr;  ///< null if the patch is cut
  std::span<const CutPatch::SideVertex> of_cut_;
  Side side_{};
  Segments segments_;
  std::uint32_t ring_ = 0, ring_end_ = 0, first_ = 0;  ///< vertices of the ring, and the first of the side
  double from_ = 0, to_ = 0;
  std::size_t size_ = 0;
};

}}  // namespace tessera::abi_0_1
