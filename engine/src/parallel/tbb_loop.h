#pragma once
// The plain loop over threads, apart so that the thread sanitizer can leave oneTBB's own templates out: it sees only half
// of oneTBB's synchronisation, the other half being in a library that is not instrumented.

#include <cstddef>

#include "base/function_ref.h"

namespace tessera::inline abi_0_1 {

/// Calls body(piece) once for each piece in [0, pieces), in the caller's arena, in any order. What the body throws comes through.
void tbb_loop(std::size_t pieces, FunctionRef<void(std::size_t)> body);

}  // namespace tessera::inline abi_0_1
