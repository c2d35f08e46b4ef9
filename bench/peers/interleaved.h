#pragma once
// Times of several programs that take turns, so that what else the machine does falls on all of them alike.

#include <time.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <vector>

#include "base/function_ref.h"

namespace tessera::bench {

/// The processor time of this process so far, all its threads together, in seconds: on a machine that does other things
/// as well it says more of one thread's work than the clock on the wall.
inline double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// How much of it `task` takes.
template <class Task>
double seconds_of(Task&& task) {
  const double start = processor_seconds();
  task();
  return processor_seconds() - start;
}

/// The time on the wall, for work on several threads.
template <class Task>
double wall_seconds_of(Task&& task) {
  const auto start = std::chrono::steady_clock::now();
  task();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// The shortest time of each of `tasks`, which say themselves how many seconds they took, over `rounds` in which all
/// take their turns of at least `turn` seconds.
inline std::vector<double> best_interleaved(int rounds, const std::vector<FunctionRef<double()>>& tasks,
                                            double turn = 0.05) {
  std::vector<double> best(tasks.size(), std::numeric_limits<double>::infinity());
  for (int round = 0; round < rounds; ++round)
    for (std::size_t k = 0; k < tasks.size(); ++k)
      for (double spent = 0; spent < turn;) {
        const double seconds = tasks[k]();
        best[k] = std::min(best[k], seconds);
        spent += seconds;
      }
  return best;
}

}  // namespace tessera::bench
