#pragma once
// The least index that threads find, whatever their order.

#include <atomic>
#include <cstddef>
#include <limits>

namespace tessera { inline namespace abi_0_1 {

class LeastIndex {
 public:
  void add(std::size_t index) {
    for (std::size_t least = least_; index < least && !least_.compare_exchange_weak(least, index);) {
    }
  }
  bool found() const { return least_ != none; }
  std::size_t index() const { return least_; }  ///< if found()

 private:
  static constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
  std::atomic<std::size_t> least_ = none;
};

}}  // namespace tessera::abi_0_1
