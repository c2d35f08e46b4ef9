#pragma once
// Positions by their bits, for tables of distinct ones.

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace tessera {

using PositionBits = std::array<std::uint32_t, 3>;

/// Of three floats; -0 counts as 0.
inline PositionBits position_bits(const float* p) {
  return {std::bit_cast<std::uint32_t>(p[0] + 0.0f), std::bit_cast<std::uint32_t>(p[1] + 0.0f),
          std::bit_cast<std::uint32_t>(p[2] + 0.0f)};
}

inline std::size_t hash(const PositionBits& bits) {
  std::uint64_t h = bits[0] * 0x9E3779B97F4A7C15u;
  h = (h ^ (h >> 32) ^ bits[1]) * 0xC2B2AE3D27D4EB4Fu;
  h = (h ^ (h >> 32) ^ bits[2]) * 0x165667B19E3779F9u;
  return static_cast<std::size_t>(h ^ (h >> 29));
}

}  // namespace tessera
