#pragma once
// How evaluation is cut into tasks, and what it reports.

#include <cstddef>

#include "tessera/execution.h"

namespace tessera { inline namespace abi_0_1 {

/// Points per task: enough that starting a task costs little, and few enough that threads finish together.
inline constexpr std::size_t points_per_task = 16384;
/// Returns how many items make a task, if there are `items` (at least 1) of `points` points each. The number of tasks
/// comes out even, so that two threads get equal shares.
inline constexpr std::size_t items_per_task(std::size_t items, std::size_t points) {
  constexpr std::size_t pair = 2 * points_per_task;
  const std::size_t tasks = 2 * ((items * points + pair - 1) / pair);
  return (items + tasks - 1) / tasks;
}
/// Up to this many points, about ten microseconds of work, one thread evaluates all. A second thread that is awake
/// saves time in calls longer than 3 to 5 microseconds. One that sleeps must be woken: calls shorter than 150
/// microseconds then take 5 microseconds longer (measured by tessera_break_even_report).
inline constexpr std::size_t serial_positions = 32768, serial_normals = 10240;

/// Reports the ISA of the kernel that ran; an empty run reports that of the plan.
inline void report_run(const Execution& execution, Isa isa, bool streaming) {
  if (!execution.report) return;
  execution.report->isa = isa;
  execution.report->streaming = streaming;
}

}}  // namespace tessera::abi_0_1
