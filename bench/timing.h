#pragma once
// Times a case and reports the shortest time of a call, items and bytes per second by it, and the distance to the
// machine's limits. These are measured in the same process around the run, unless the environment has
// TESSERA_BENCH_LIMITS=0, as tools/perf compare sets it. When instructions are counted (counting.h), a call is made
// twice, and the second one counts.

#include <benchmark/benchmark.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <limits>
#include <optional>
#include <string_view>

#include "base/function_ref.h"
#include "counting.h"
#include "tessera/limits.h"
#include "tessera/status.h"

namespace tessera::bench {

inline double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Calls `before` and then `call` once per iteration, in an arena of `threads`; only `call` is timed. Returns the
/// shortest time in seconds; empty if a call failed, which skips the case with its message.
inline std::optional<double> time_calls(
    benchmark::State& state, int threads, FunctionRef<Status()> call, FunctionRef<void()> before = [] {}) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  tbb::task_arena arena(threads);
  double best = std::numeric_limits<double>::infinity();
  for (auto _ : state) {
    Status status;
    if (counting()) arena.execute([&] { status = call(); });
    before();
    const auto start = std::chrono::steady_clock::now();
    arena.execute([&] {
      if (counting()) begin_count();
      status = call();
      if (counting()) end_count();
    });
    const double seconds = seconds_since(start);
    if (!status.ok()) {
      state.SkipWithError(status.message().c_str());
      return {};
    }
    state.SetIterationTime(seconds);
    best = std::min(best, seconds);
  }
  return best;
}

inline bool limits_are_wanted() {
  const char* wish = std::getenv("TESSERA_BENCH_LIMITS");
  return !counting() && (wish == nullptr || std::string_view(wish) != "0");
}

/// The machine's limits before and after a run: the better rates of both, since a disturbed measurement must not
/// flatter the run. Zeros if they are not requested.
class LimitsAround {
 public:
  LimitsAround(std::optional<Isa> isa, double bytes)
      : options_{.isa = isa, .store_bytes = static_cast<std::size_t>(bytes)}, before_(measure()) {}

  /// Empty if they cannot be measured, which skips the case.
  std::optional<Limits> best(benchmark::State& state) const {
    const Result<Limits> after = measure();
    if (!before_ || !after) {
      state.SkipWithError("the machine's limits could not be measured");
      return {};
    }
    const auto better = [](double a, double b) { return std::max(a, b); };
    Limits limits = *before_;
    limits.float_operations_per_second = better(limits.float_operations_per_second, after->float_operations_per_second);
    limits.double_operations_per_second =
        better(limits.double_operations_per_second, after->double_operations_per_second);
    limits.plain_store_bytes_per_second =
        better(limits.plain_store_bytes_per_second, after->plain_store_bytes_per_second);
    limits.streaming_store_bytes_per_second =
        better(limits.streaming_store_bytes_per_second, after->streaming_store_bytes_per_second);
    limits.store_bytes_per_second = better(limits.store_bytes_per_second, after->store_bytes_per_second);
    return limits;
  }

 private:
  Result<Limits> measure() const { return limits_are_wanted() ? measure_limits(options_) : Limits{}; }

  LimitsOptions options_;
  Result<Limits> before_;
};

/// Reports items_per_second and bytes_per_second (if bytes > 0) by the best time.
inline void report_rates(benchmark::State& state, double best, double items, double bytes = 0) {
  state.counters["items_per_second"] = items / best;
  if (bytes > 0) state.counters["bytes_per_second"] = bytes / best;
}

/// Reports limit_fraction: the time that `work` takes at the limits of one thread (limits.h) over the best time. For
/// one thread only: the limits of shared hardware are not those of one thread.
inline void report_limit(benchmark::State& state, double best, const Limits& limits, const Work& work) {
  if (limits.store_bytes_per_second > 0) state.counters["limit_fraction"] = seconds_at_limit(limits, work) / best;
}

}  // namespace tessera::bench
