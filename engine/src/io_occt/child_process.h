#pragma once
// Work in a process of its own: what it breaks, and what it takes, ends with it.

#include <cstddef>
#include <string>
#include <string_view>

#include "base/function_ref.h"
#include "tessera/status.h"

namespace tessera::inline abi_0_1 {

struct ChildLimits {
  std::size_t memory_bytes = 0;  ///< beyond what this process has
  unsigned cpu_seconds = 0;
};

/// Runs `work` in a forked child and returns the bytes that it returns. The child's standard streams lead nowhere, and it
/// ends with this process. Errors, in which `worker` is the subject: internal (it crashed, threw, took too long, was
/// killed; or there can be no child), out_of_memory.
Result<std::string> run_in_child(FunctionRef<std::string()> work, const ChildLimits& limits, std::string_view worker);

}  // namespace tessera::inline abi_0_1
