#pragma once
// Rounds bounds from double to float.

#include <bit>
#include <cstdint>

namespace tessera { inline namespace abi_0_1 {

/// Returns the least float that is not below x >= 0.
inline float rounded_up(double x) {
  const auto nearest = static_cast<float>(x);
  return double(nearest) < x ? std::bit_cast<float>(std::bit_cast<std::uint32_t>(nearest) + 1) : nearest;
}

}}  // namespace tessera::abi_0_1
