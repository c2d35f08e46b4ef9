#pragma once
// Loops over threads, with cancellation and progress. The only floor that includes TBB.

#include <cstddef>

#include "base/function_ref.h"
#include "base/internal_export.h"
#include "tessera/execution.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// Calls body(begin, end) for pieces of at most `grain` elements that together cover [0, count) once. Runs in the
/// caller's arena; a single piece runs on the calling thread. The pieces are the same for any number of threads. Sets
/// execution.report->tasks. Errors: cancelled; what the body throws, as a Status.
TESSERA_INTERNAL_EXPORT Status parallel_for(std::size_t count, std::size_t grain, const Execution& execution,
                                            FunctionRef<void(std::size_t, std::size_t)> body);

}}  // namespace tessera::abi_0_1
