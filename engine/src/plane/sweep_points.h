#pragma once
// Points of the parameter plane in the order in which a sweep along u meets them.

#include <cstdint>
#include <span>
#include <vector>

#include "tessera/geometry.h"

namespace tessera { inline namespace abi_0_1 {

/// Points by growing u, those of one u by growing v. Equal points have one rank. So the sweep line leans a little: no
/// segment between two ranks is parallel to it.
class SweepPoints {
 public:
  /// Sorts up to 2^32 - 2 finite points. Time: O(n log n), for evenly spread points O(n). Allocates only when there are
  /// more points than ever before.
  void sort(std::span<const ParameterPoint> points);

  std::uint32_t count() const { return static_cast<std::uint32_t>(at_.size()); }  ///< the number of distinct points
  const ParameterPoint& at(std::uint32_t rank) const { return at_[rank]; }
  /// Returns the first of the given points that has this rank.
  std::uint32_t index_of(std::uint32_t rank) const { return first_[rank]; }
  std::uint32_t rank_of(std::uint32_t index) const { return ranks_[index]; }

 private:
  struct Key {
    ParameterPoint at;
    std::uint32_t index;   ///< of the given point
    std::uint32_t digits;  ///< of the place between the smallest and the largest u
  };
  void sort_by_digits();

  std::vector<Key> keys_, spare_;
  std::vector<std::uint32_t> starts_;  ///< for each digit, the place of its next key
  std::vector<ParameterPoint> at_;     ///< by rank
  std::vector<std::uint32_t> first_;   ///< by rank
  std::vector<std::uint32_t> ranks_;   ///< by index
};

}}  // namespace tessera::abi_0_1
