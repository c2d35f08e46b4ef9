#pragma once
// The speed limits of this machine, measured in this process, and how long a piece of work takes at them.
//
// Threads: any number of calls at once, which then share the machine and measure less.

#include <cstddef>
#include <optional>

#include "tessera/execution.h"
#include "tessera/status.h"

#pragma GCC visibility push(default)
namespace tessera { inline namespace abi_0_1 {

/// The work that a call cannot avoid, whatever the kernel.
struct Work {
  double lane_operations = 0;     ///< fused multiply-adds, one float (or double) each
  double bytes_written = 0;       ///< lower bound
  double bytes_read = 0;          ///< lower bound
  bool double_precision = false;  ///< whether the multiply-adds are of doubles
};

/// Rates of one thread.
struct Limits {
  Isa isa = Isa::sse2;                          ///< the measured instruction set
  double float_operations_per_second = 0;       ///< fused multiply-adds, one float each (SSE2: multiply and add)
  double double_operations_per_second = 0;      ///< likewise, one double each
  double store_bytes_per_second = 0;            ///< the better of plain and streaming fill at the requested size
  double plain_store_bytes_per_second = 0;      ///< with plain stores
  double streaming_store_bytes_per_second = 0;  ///< with streaming stores, past the caches
};

/// Options of measure_limits().
struct LimitsOptions {
  std::optional<Isa> isa = {};           ///< default_isa() if empty
  std::size_t store_bytes = 160u << 20;  ///< size of the filled buffer: that of the output in question
};

/// Measures on the calling thread, the best of several runs, in a fraction of a second by default. Errors:
/// isa_unavailable, out_of_memory. Memory: `store_bytes` during the call.
Result<Limits> measure_limits(const LimitsOptions& options = {});

/// Returns the larger of the operations over their rate and the larger byte count over the store rate, in seconds.
/// Needs rates above 0, as measure_limits() returns them; otherwise the result may be infinite or NaN. Allocates
/// nothing.
double seconds_at_limit(const Limits& limits, const Work& work);

}}  // namespace tessera::abi_0_1
#pragma GCC visibility pop
