#pragma once
// The end of streaming, and the probes of the machine's limits, in vectors of any width.
//
// Needs before it, outside of the instruction set's namespace: kernel/isa/lanes.h, kernel/store/memory_kernels.h.

/// Uses independent chains to hide the latency of the multiply-adds, as many as leave registers for both constants: a
/// chain that goes through memory would take twice as long. The sum of all keeps the compiler from dropping them.
template <class L>
int fma_rate(std::size_t rounds, typename L::Scalar* sink) {
  constexpr int chains = L::registers / 4 * 3 < 16 ? L::registers / 4 * 3 : 16;
  typename L::Batch chain[chains];
  for (int i = 0; i < chains; ++i) chain[i] = L::broadcast(static_cast<typename L::Scalar>(i));
  const auto a = L::broadcast(static_cast<typename L::Scalar>(0.999));
  const auto b = L::broadcast(static_cast<typename L::Scalar>(0.001));
  for (std::size_t k = 0; k < rounds * 16 / chains; ++k) {
#pragma GCC unroll 16
    for (int i = 0; i < chains; ++i) chain[i] = L::fma(chain[i], a, b);
  }
  for (int i = 1; i < chains; ++i) chain[0] = chain[0] + chain[i];
  L::store_first(sink, chain[0], 1);
  return L::width;
}

/// Makes streamed results visible to other threads.
template <class L>
void finish_streaming() {
  L::fence();
}

template <class L>
void fill_memory(void* memory, std::size_t bytes, bool streaming) {
  auto* out = static_cast<typename L::Scalar*>(memory);
  const auto value = L::broadcast(1);
  const std::size_t count = bytes / sizeof(typename L::Scalar);
  if (streaming) {
    for (std::size_t k = 0; k < count; k += L::width) L::stream(out + k, value);
    L::fence();
  } else {
    for (std::size_t k = 0; k < count; k += L::width) L::store(out + k, value);
  }
}
