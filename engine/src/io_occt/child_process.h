#pragma once
// Runs work in a process of its own: a crash, and the memory it takes, end with that process.

#include <cstddef>
#include <string>
#include <string_view>

#include "base/function_ref.h"
#include "tessera/status.h"

namespace tessera::inline abi_0_1 {

struct ChildLimits {
  std::size_t memory_bytes = 0;  ///< in addition to what this process has
  unsigned cpu_seconds = 0;
};

/// Runs `work` in a forked child and returns the bytes that it returns. The child's standard streams lead to /dev/null,
/// and it ends with this process. Errors, whose messages have `worker` as subject: internal (it crashed, threw, took
/// too long or was killed, or could not be started), out_of_memory.
Result<std::string> run_in_child(FunctionRef<std::string()> work, const ChildLimits& limits, std::string_view worker);

}  // namespace tessera::inline abi_0_1
