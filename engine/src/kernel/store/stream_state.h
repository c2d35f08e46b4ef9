#pragma once
// The state of an output that is streamed in whole cache lines but computed in pieces.

namespace tessera { inline namespace abi_0_1 { namespace kernel {

/// Numbers that follow each other in memory and come in pieces by several kernel calls; those of an incomplete line
/// wait here. The first and the last line may be shared with others, and are stored plainly. Initially both pointers
/// are the place of the first number.
struct StreamState {
  float* first = nullptr;  ///< the first of the numbers that wait, or a whole number of lines before it
  float* next = nullptr;   ///< where the next number goes
  alignas(64) float carry[16] = {};
};

}}}  // namespace tessera::abi_0_1::kernel
