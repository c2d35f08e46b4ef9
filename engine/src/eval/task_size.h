#pragma once
// How evaluation is cut into tasks, and what it reports.

#include <cstddef>

#include "tessera/execution.h"

namespace tessera::inline abi_0_1 {

/// Points a task: enough to hide its cost, few enough to balance.
inline constexpr std::size_t points_per_task = 16384;
/// Items, at least one in all, of so many points each that make a task: an even number of tasks, for two threads to get
/// the same.
inline constexpr std::size_t items_per_task(std::size_t items, std::size_t points) {
  constexpr std::size_t pair = 2 * points_per_task;
  const std::size_t tasks = 2 * ((items * points + pair - 1) / pair);
  return (items + tasks - 1) / tasks;
}
/// Up to these many points, some ten microseconds' work, one thread takes them all. A second one that is awake pays
/// from 3 to 5 microseconds on; one that has slept costs the call 5 and more until it pays, from 150 on
/// (tessera_break_even_report).
inline constexpr std::size_t serial_positions = 32768, serial_normals = 10240;

/// Reports the ISA of the kernel that ran; an empty run reports that of the plan.
inline void report_run(const Execution& execution, Isa isa, bool streaming) {
  if (!execution.report) return;
  execution.report->isa = isa;
  execution.report->streaming = streaming;
}

}  // namespace tessera::inline abi_0_1
