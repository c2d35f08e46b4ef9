#pragma once
// The least index that threads find, whatever their order.

#include <atomic>
#include <cstddef>
#include <limits>

#include "parallel/parallel_for.h"

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

/// Returns the least k below `count` that find(begin, end) finds in the pieces of [0, count), or `count` if there is
/// none. `find` returns `end` if it finds none. Errors: those of parallel_for().
template <class Find>
Result<std::size_t> find_first(std::size_t count, const Find& find, std::size_t piece = std::size_t{1} << 16) {
  LeastIndex least;
  const Status status = parallel_for(count, piece, {}, [&](std::size_t begin, std::size_t end) {
    if (const std::size_t k = find(begin, end); k != end) least.add(k);
  });
  if (!status.ok()) return status;
  return least.found() ? least.index() : count;
}

}}  // namespace tessera::abi_0_1
