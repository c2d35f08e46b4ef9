#pragma once
// Kernels that end stores past the caches, and that probe the machine's limits.

#include <cstddef>

namespace tessera { inline namespace abi_0_1 { namespace kernel {

struct MemoryKernels {
  /// For limits.h: `rounds` times 16 independent fused multiply-adds of whole vectors. Return the lanes of a vector.
  int (*fma_f32)(std::size_t rounds, float* sink);
  int (*fma_f64)(std::size_t rounds, double* sink);
  /// For limits.h: fills bytes (a multiple of 64, aligned to 64) with full-width stores.
  void (*fill)(void* memory, std::size_t bytes, bool streaming);
  /// Call it once a task has streamed, before other threads get its results; not once per block: a fence waits for
  /// memory.
  void (*finish_streaming)();
};

}}}  // namespace tessera::abi_0_1::kernel
