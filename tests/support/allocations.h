#pragma once
// Counts the program's calls of operator new and their bytes; lets memory run out on request. Link
// support/allocations.cpp into the executable.

#include <cstddef>

namespace tessera::test {

/// Calls of operator new so far, of all threads.
std::size_t allocation_count();
/// The bytes of these calls in all; deallocation does not reduce them.
std::size_t allocated_bytes();

/// The most bytes that were held at a time since restart_peak(), of all threads.
std::size_t peak_bytes();
/// Returns the bytes that are held now; the peak restarts at them.
std::size_t restart_peak();

/// Makes the n-th call of operator new from now on, counted from 0 over all threads, throw std::bad_alloc, and only
/// that one. Calls by Embree and oneTBB do not count: their error handling is their own.
void fail_allocation(std::size_t n);
/// Ends that. Returns whether a call has failed.
bool stop_failing();

}  // namespace tessera::test
