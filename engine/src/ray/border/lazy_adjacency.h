#pragma once
// Shared borders, found on first use: closest hits of rays that leave no surface need none.

#include <atomic>
#include <cstddef>
#include <memory>
#include <mutex>

#include "ray/border/adjacency.h"

namespace tessera { inline namespace abi_0_1 {

/// Const calls from any number of threads.
class LazyAdjacency {
 public:
  /// Allocates memory the first time. Throws bad_alloc.
  const Adjacency& of(const SetView& set) const {
    if (const Adjacency* const made = found()) return *made;
    const std::lock_guard lock(mutex_);
    if (!owned_) owned_ = std::make_unique<Adjacency>(set);
    made_.store(owned_.get(), std::memory_order_release);
    return *owned_;
  }
  /// Returns null before of() was called.
  const Adjacency* found() const { return made_.load(std::memory_order_acquire); }
  void forget() {
    made_ = nullptr;
    owned_.reset();
  }
  std::size_t memory_bytes() const {
    const Adjacency* const made = found();
    return made ? made->memory_bytes() : 0;
  }

 private:
  mutable std::mutex mutex_;
  mutable std::unique_ptr<Adjacency> owned_;
  mutable std::atomic<const Adjacency*> made_ = nullptr;
};

}}  // namespace tessera::abi_0_1
