#pragma once
// Sums and products of counts that stop at the size of the largest array: where memory is small, a plan or a file may
// count more than there can be. Whoever asks for an array of that size is told that there is no memory.

#include <algorithm>
#include <cstddef>
#include <limits>

namespace tessera { inline namespace abi_0_1 {

inline constexpr auto max_array = static_cast<std::size_t>(std::numeric_limits<std::ptrdiff_t>::max());

constexpr std::size_t saturated_sum(std::size_t a, std::size_t b) {
  return b >= max_array ? max_array : std::min(a, max_array - b) + b;
}

constexpr std::size_t saturated_product(std::size_t a, std::size_t b) {
  return b != 0 && a > max_array / b ? max_array : a * b;
}

}}  // namespace tessera::abi_0_1
