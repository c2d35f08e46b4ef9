#pragma once
// Turns positions into keys by their bits, for tables of distinct positions.

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace tessera { inline namespace abi_0_1 {

using PositionBits = std::array<std::uint32_t, 3>;
using DoublePositionBits = std::array<std::uint64_t, 3>;

/// Returns the key of three floats; -0 counts as 0.
inline PositionBits position_bits(const float* p) {
  return {std::bit_cast<std::uint32_t>(p[0] + 0.0f), std::bit_cast<std::uint32_t>(p[1] + 0.0f),
          std::bit_cast<std::uint32_t>(p[2] + 0.0f)};
}

/// Returns the key of three doubles; -0 counts as 0.
inline DoublePositionBits position_bits(const double* p) {
  return {std::bit_cast<std::uint64_t>(p[0] + 0.0), std::bit_cast<std::uint64_t>(p[1] + 0.0),
          std::bit_cast<std::uint64_t>(p[2] + 0.0)};
}

inline std::size_t hash(const PositionBits& bits) {
  std::uint64_t h = bits[0] * 0x9E3779B97F4A7C15u;
  h = (h ^ (h >> 32) ^ bits[1]) * 0xC2B2AE3D27D4EB4Fu;
  h = (h ^ (h >> 32) ^ bits[2]) * 0x165667B19E3779F9u;
  return static_cast<std::size_t>(h ^ (h >> 29));
}

inline std::size_t hash(const DoublePositionBits& bits) {
  const auto folded = [](std::uint64_t x) { return static_cast<std::uint32_t>((x * 0x9E3779B97F4A7C15u) >> 32); };
  return hash(PositionBits{folded(bits[0]), folded(bits[1]), folded(bits[2])});
}

}}  // namespace tessera::abi_0_1
