#pragma once
// How often the program has asked for memory by operator new, and for how much; and memory that runs out on request. Link
// support/allocations.cpp into the executable.

#include <cstddef>

namespace tessera::test {

/// Calls of operator new so far, of all threads.
std::size_t allocation_count();
/// What they asked for in all; what was given back is not taken off.
std::size_t allocated_bytes();

/// The most bytes that were held at a time since restart_peak(), of all threads.
std::size_t peak_bytes();
/// The bytes that are held now; the peak begins with them.
std::size_t restart_peak();

/// From now on the n-th call of operator new, counted from 0 over all threads, throws std::bad_alloc, and that one alone.
/// Calls by Embree, oneTBB and tinygltf don't count: what they do about it is theirs.
void fail_allocation(std::size_t n);
/// Ends that. Whether one has failed.
bool stop_failing();

}  // namespace tessera::test
