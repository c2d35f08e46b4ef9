#pragma once
// Bezier patches of any degrees that share memory: a few allocations instead of one per patch.

#include <algorithm>
#include <cstddef>
#include <memory>

#include "tessera/bezier_patch.h"

namespace tessera { inline namespace abi_0_1 {

/// The memory for the points of a file's patches. A block lives as long as a patch that has points in it.
class PatchPool {
 public:
  /// Returns the patch with its numbers in the pool.
  BezierPatch placed(const BezierPatch& patch) {
    const auto points = patch.points();
    const auto weights = patch.weights();
    reserve(points.size_bytes() + weights.size_bytes());
    BezierPatch copy = patch;
    copy.points_ = static_cast<const Vec3*>(put(points));
    if (patch.is_rational()) copy.weights_ = static_cast<const double*>(put(weights));
    copy.memory_ = memory_;
    return copy;
  }

 private:
  /// Limits the unused rest of the last block, which is small beside a file that fills it.
  static constexpr std::size_t largest = 48 * 1024;

  void reserve(std::size_t bytes) {
    if (bytes <= size_ - used_) return;
    size_ = std::max(bytes, std::clamp<std::size_t>(2 * size_, 512, largest));
    used_ = 0;
    memory_ = SharedMemory(size_);
  }
  template <class T>
  void* put(std::span<const T> values) {
    T* const place = reinterpret_cast<T*>(static_cast<std::byte*>(memory_.data()) + used_);
    std::uninitialized_copy(values.begin(), values.end(), place);
    used_ += values.size_bytes();
    return place;
  }

  SharedMemory memory_;
  std::size_t size_ = 0, used_ = 0;
};

}}  // namespace tessera::abi_0_1
