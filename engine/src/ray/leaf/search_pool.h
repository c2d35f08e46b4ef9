#pragma once
// Memory of searches that the threads of one scene share, so that repeated queries allocate nothing.

#include <memory>
#include <mutex>
#include <vector>

#include "base/aligned.h"

namespace tessera { inline namespace abi_0_1 {

/// A part of a leaf's square that may hold roots.
struct SearchBox {
  double u0 = 0, v0 = 0, du = 1, dv = 1;
  int depth = 0;  ///< number of cuts to this box
};

struct SearchMemory {
  UnsetVector<double> nets;
  std::vector<SearchBox> boxes;
};

/// Holds as many pieces of memory as there were ever searches at a time. Calls from any number of threads.
class SearchPool {
 public:
  /// Returns memory for so many values and boxes, or null if there is none.
  std::unique_ptr<SearchMemory> take(std::size_t values, std::size_t boxes) noexcept {
    try {
      std::unique_ptr<SearchMemory> memory = idle();
      if (!memory) memory = std::make_unique<SearchMemory>();
      memory->nets.resize(values);
      memory->boxes.resize(boxes);
      return memory;
    } catch (...) {
      return nullptr;
    }
  }
  void give(std::unique_ptr<SearchMemory> memory) noexcept {
    try {
      const std::lock_guard lock(mutex_);
      idle_.push_back(std::move(memory));
    } catch (...) {  // the memory is then freed
    }
  }

 private:
  std::unique_ptr<SearchMemory> idle() {
    const std::lock_guard lock(mutex_);
    if (idle_.empty()) return nullptr;
    std::unique_ptr<SearchMemory> memory = std::move(idle_.back());
    idle_.pop_back();
    return memory;
  }

  std::mutex mutex_;
  std::vector<std::unique_ptr<SearchMemory>> idle_;
};

}}  // namespace tessera::abi_0_1
