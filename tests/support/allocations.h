#pragma once
// How often the program has asked for memory by operator new. Link support/allocations.cpp into the executable.

#include <cstddef>

namespace tessera::test {

/// Calls of operator new so far, of all threads.
std::size_t allocation_count();

}  // namespace tessera::test
