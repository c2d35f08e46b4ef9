#pragma once
// The plain loop over threads. A file of its own lets the thread sanitizer exclude oneTBB's templates: it sees only
// half of oneTBB's synchronisation, because the other half is in a library that is not instrumented.

#include <cstddef>

#include "base/function_ref.h"

namespace tessera::inline abi_0_1 {

/// Calls body(piece) once for each piece in [0, pieces), in the caller's arena, in any order. Exceptions of the body
/// propagate.
void tbb_loop(std::size_t pieces, FunctionRef<void(std::size_t)> body);

}  // namespace tessera::inline abi_0_1
