#include "tessera/limits.h"

#include <algorithm>
#include <chrono>

#include "base/aligned.h"
#include "kernel/table/kernel_table.h"
#include "tessera/guard.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Returns the seconds of the fastest of several runs.
template <class Run>
double best_seconds(int runs, Run&& run) {
  double best = 1e30;
  for (int k = 0; k < runs; ++k) {
    const auto start = std::chrono::steady_clock::now();
    run();
    best = std::min(best, seconds_since(start));
  }
  return best;
}

template <class T>
double operations_per_second(int (*probe)(std::size_t, T*)) {
  constexpr std::size_t rounds = 100'000, chains = 16;
  T sink = 0;
  int width = 0;
  const double seconds = best_seconds(12, [&] { width = probe(rounds, &sink); });
  return static_cast<double>(rounds * chains) * width / seconds;
}

}  // namespace

Result<Limits> measure_limits(const LimitsOptions& options) {
  return guarded([&]() -> Result<Limits> {
    const Result<Isa> isa = usable_isa(options.isa);
    if (!isa) return isa.status();
    const auto& kernels = kernel::kernels(*isa);
    Limits limits;
    limits.isa = *isa;
    const std::size_t bytes = std::max<std::size_t>(options.store_bytes / cache_line, 1) * cache_line;
    AlignedVector<std::byte> memory;
    if (bytes > memory.max_size())
      return Status(StatusCode::out_of_memory,
                    std::to_string(bytes) + " bytes to fill are more than memory can address");
    memory.resize(bytes);
    limits.float_operations_per_second = operations_per_second(kernels.fma_f32);
    limits.double_operations_per_second = operations_per_second(kernels.fma_f64);

    const int runs = static_cast<int>(std::clamp<std::size_t>((std::size_t{1} << 30) / bytes, 5, 1000));
    const auto fill_rate = [&](bool streaming) {
      return static_cast<double>(bytes) / best_seconds(runs, [&] { kernels.fill(memory.data(), bytes, streaming); });
    };
    limits.plain_store_bytes_per_second = fill_rate(false);
    limits.streaming_store_bytes_per_second = fill_rate(true);
    limits.store_bytes_per_second =
        std::max(limits.plain_store_bytes_per_second, limits.streaming_store_bytes_per_second);
    return limits;
  });
}

double seconds_at_limit(const Limits& limits, const Work& work) {
  const double rate = work.double_precision ? limits.double_operations_per_second : limits.float_operations_per_second;
  return std::max(work.lane_operations / rate,
                  std::max(work.bytes_written, work.bytes_read) / limits.store_bytes_per_second);
}

}}  // namespace tessera::abi_0_1
