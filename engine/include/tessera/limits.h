#pragma once
// The limits of this machine, measured in this process, and how long a piece of work takes at them.

#include <cstddef>
#include <optional>

#include "tessera/execution.h"
#include "tessera/status.h"

#pragma GCC visibility push(default)
namespace tessera::inline abi_0_1 {

/// Work that a call cannot avoid, whatever the kernel.
struct Work {
  double lane_operations = 0;     ///< fused multiply-adds, one float (or double) each
  double bytes_written = 0;       ///< at the least
  double bytes_read = 0;          ///< at the least
  bool double_precision = false;  ///< whose multiply-adds are counted
};

/// Rates of one thread.
struct Limits {
  Isa isa = Isa::sse2;                          ///< the one that was measured
  double float_operations_per_second = 0;       ///< fused multiply-adds, one float each (SSE2: multiply and add)
  double double_operations_per_second = 0;      ///< the same in doubles
  double store_bytes_per_second = 0;            ///< the better of plain and streaming fill at the size asked for
  double plain_store_bytes_per_second = 0;      ///< by plain stores
  double streaming_store_bytes_per_second = 0;  ///< past the caches
};

/// What is measured, and how long.
struct LimitsOptions {
  std::optional<Isa> isa = {};           ///< default_isa() if empty
  std::size_t store_bytes = 160u << 20;  ///< size of the buffer that is filled: that of the output in question
};

/// Measures in about a quarter of a second on the calling thread, best of several.
/// Errors: isa_unavailable, out_of_memory.
Result<Limits> measure_limits(const LimitsOptions& options = {});

/// The larger of operations over their rate and bytes over theirs.
double seconds_at_limit(const Limits& limits, const Work& work);

}  // namespace tessera::inline abi_0_1
#pragma GCC visibility pop
