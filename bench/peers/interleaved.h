#pragma once
// Times several programs in turns, so that other work of the machine affects all of them alike.

#include <time.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <vector>

#include "base/function_ref.h"

namespace tessera::bench {

/// The processor time of this process so far, over all threads, in seconds. On a machine that also does other work it
/// measures the work of one thread better than the wall clock.
inline double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// The processor time of `task`.
template <class Task>
double seconds_of(Task&& task) {
  const double start = processor_seconds();
  task();
  return processor_seconds() - start;
}

/// The wall-clock time of `task`, for work on several threads.
template <class Task>
double wall_seconds_of(Task&& task) {
  const auto start = std::chrono::steady_clock::now();
  task();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// The shortest time of each of `tasks`, which return their own times in seconds. In each of `rounds` rounds every task
/// gets a turn of at least `turn` seconds.
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
