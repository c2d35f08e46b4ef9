#pragma once
// Output that goes past the caches in whole lines, though it is made in pieces of any length.

namespace tessera::inline abi_0_1::kernel {

/// Numbers that follow each other in memory, in pieces by several calls of kernels: those of a line that isn't whole yet wait
/// here. The first and the last line may be shared with others, and are stored plainly. It begins with both pointers where
/// the first number goes.
struct StreamState {
  float* first = nullptr;  ///< of the numbers that wait, or a whole number of lines before it
  float* next = nullptr;   ///< where the next number goes
  alignas(64) float carry[16] = {};
};

}  // namespace tessera::inline abi_0_1::kernel
