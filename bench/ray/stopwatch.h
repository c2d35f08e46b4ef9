#pragma once
// Times the rival of a case, by turns with the case.

#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <limits>

#include "timing.h"

namespace tessera::bench {

/// The best of all turns, in seconds.
class Stopwatch {
 public:
  template <class Work>
  void time(int threads, Work work) {
    tbb::task_arena arena(threads);
    const auto start = std::chrono::steady_clock::now();
    arena.execute(work);
    best_ = std::min(best_, seconds_since(start));
  }
  double best() const { return best_; }

 private:
  double best_ = std::numeric_limits<double>::infinity();
};

}  // namespace tessera::bench
