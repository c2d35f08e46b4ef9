#pragma once
// How often the program has asked for memory by operator new, and for how much. Link support/allocations.cpp into the executable.

#include <cstddef>

namespace tessera::test {

/// Calls of operator new so far, of all threads.
std::size_t allocation_count();
/// What they asked for in all; what was given back is not taken off.
std::size_t allocated_bytes();

}  // namespace tessera::test
