#pragma once
// How evaluation is cut into tasks, and what it reports.

#include <cstddef>

#include "tessera/execution.h"

namespace tessera {

/// Points a task: enough to hide its cost, few enough to balance.
inline constexpr std::size_t points_per_task = 16384;
/// Up to these many points one thread is faster than waking another.
inline constexpr std::size_t serial_positions = 32768, serial_normals = 10240;

/// What the report says of the ISA comes from the kernel that ran; the plan's own value stands in for an empty run.
inline void report_run(const Execution& execution, Isa isa, bool streaming) {
  if (!execution.report) return;
  execution.report->isa = isa;
  execution.report->streaming = streaming;
}

}  // namespace tessera
