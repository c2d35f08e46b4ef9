#pragma once
// Arenas for threads of the library's own, as wide as their caller's.

#include "base/function_ref.h"
#include "base/internal_export.h"

namespace tessera { inline namespace abi_0_1 {

/// Returns how many threads the caller's arena has.
TESSERA_INTERNAL_EXPORT int arena_threads();

/// Calls work() in an arena of `threads` threads, at least 1, this thread among them, that no other call uses. Unlike
/// on_threads(), work() may block. Exceptions of work() propagate; throws std::bad_alloc.
TESSERA_INTERNAL_EXPORT void in_own_arena(int threads, FunctionRef<void()> work);

}}  // namespace tessera::abi_0_1
