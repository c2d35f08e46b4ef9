#pragma once
// Times of several programs that take turns, so that what else the machine does falls on all of them alike.

#include <algorithm>
#include <chrono>
#include <limits>
#include <vector>

#include "base/function_ref.h"

namespace tessera::bench {

/// The shortest time of each of `tasks`, in seconds, over `rounds` in which all take their turns of at least 50 ms.
inline std::vector<double> best_interleaved(int rounds, const std::vector<FunctionRef<void()>>& tasks) {
  using Clock = std::chrono::steady_clock;
  constexpr double turn = 0.05;
  std::vector<double> best(tasks.size(), std::numeric_limits<double>::infinity());
  for (int round = 0; round < rounds; ++round)
    for (std::size_t k = 0; k < tasks.size(); ++k)
      for (double spent = 0; spent < turn;) {
        const auto start = Clock::now();
        tasks[k]();
        const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
        best[k] = std::min(best[k], seconds);
        spent += seconds;
      }
  return best;
}

}  // namespace tessera::bench
