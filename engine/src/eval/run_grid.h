#pragma once
// Calls the grid kernel of an instruction set. The CMake option TESSERA_PLANT_SLOWDOWN makes these calls slower, for
// tests of the tools that watch speed.

#include <algorithm>

#include "kernel/table/kernel_table.h"

namespace tessera { inline namespace abi_0_1 {

#ifdef TESSERA_PLANT_SLOWDOWN
inline constexpr int planted_slowdown = TESSERA_PLANT_SLOWDOWN;
#else
inline constexpr int planted_slowdown = 0;
#endif

template <class T>
Isa call_grid_kernel(const kernel::KernelTable& kernels, const kernel::GridJob<T>& job) {
  if constexpr (sizeof(T) == 4) {
    return kernels.grid_f32(job);
  } else {
    return kernels.grid_f64(job);
  }
}

/// Evaluates `planted_slowdown` percent of a job's rows once more, to the same place, so that results do not change.
/// Waits until half a job's rows have come together, so that the cost of the extra calls does not count; until then the
/// rows are owed by this thread's next jobs.
template <class T>
void repeat_rows(const kernel::KernelTable& kernels, const kernel::GridJob<T>& job) {
  thread_local int owed = 0;  // hundredths of a row
  const int rows = job.u_end - job.u_begin, together = std::max(1, rows / 2);
  owed += planted_slowdown * rows;
  if (owed < 100 * together) return;
  const int repeated = std::min(rows, owed / 100);
  owed -= 100 * repeated;
  kernel::GridJob<T> part = job;
  part.u_end = part.u_begin + repeated;
  call_grid_kernel(kernels, part);
}

template <class T>
Isa run_grid(const kernel::KernelTable& kernels, const kernel::GridJob<T>& job) {
  if constexpr (planted_slowdown > 0) repeat_rows(kernels, job);
  return call_grid_kernel(kernels, job);
}

}}  // namespace tessera::abi_0_1
