#pragma once
// A shared pointer that threads load and store.

#include <memory>
#include <mutex>
#include <utility>

namespace tessera { inline namespace abi_0_1 {

/// Holds one shared pointer, empty at first. Threads: any number.
template <class T>
class SharedSlot {
 public:
  std::shared_ptr<const T> load() const {
    const std::lock_guard lock(mutex_);
    return value_;
  }
  /// The value that was held before is released outside of the lock.
  void store(std::shared_ptr<const T> value) {
    {
      const std::lock_guard lock(mutex_);
      value_.swap(value);
    }
  }

 private:
  mutable std::mutex mutex_;
  std::shared_ptr<const T> value_;
};

}}  // namespace tessera::abi_0_1
