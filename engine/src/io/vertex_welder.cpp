#include "io/vertex_welder.h"

#include <bit>

namespace tessera {
namespace {

using Bits3 = std::array<std::uint32_t, 3>;

/// -0 + 0 is 0.
Bits3 bits_of(const float* p) {
  return {std::bit_cast<std::uint32_t>(p[0] + 0.0f), std::bit_cast<std::uint32_t>(p[1] + 0.0f),
          std::bit_cast<std::uint32_t>(p[2] + 0.0f)};
}

std::size_t hash(const Bits3& bits) {
  std::uint64_t h = bits[0] * 0x9E3779B97F4A7C15u;
  h = (h ^ (h >> 32) ^ bits[1]) * 0xC2B2AE3D27D4EB4Fu;
  h = (h ^ (h >> 32) ^ bits[2]) * 0x165667B19E3779F9u;
  return static_cast<std::size_t>(h ^ (h >> 29));
}

}  // namespace

std::size_t VertexWelder::slot_of(const std::array<float, 3>& position) const {
  const Bits3 bits = bits_of(position.data());
  std::size_t slot = hash(bits) & (table_.size() - 1);
  while (table_[slot] != none && bits_of(&positions_[3 * std::size_t{table_[slot]}]) != bits)
    slot = (slot + 1) & (table_.size() - 1);
  return slot;
}

std::uint32_t VertexWelder::index_of(const std::array<float, 3>& position) {
  const std::size_t slot = slot_of(position);
  if (table_[slot] != none) return table_[slot];
  const std::size_t index = positions_.size() / 3;
  table_[slot] = static_cast<std::uint32_t>(index);
  positions_.insert(positions_.end(), position.begin(), position.end());
  if (2 * (index + 1) > table_.size()) grow();
  return static_cast<std::uint32_t>(index);
}

void VertexWelder::grow() {
  const std::size_t vertices = positions_.size() / 3;
  table_.assign(2 * table_.size(), none);
  for (std::size_t k = 0; k < vertices; ++k) {
    const float* const p = &positions_[3 * k];
    table_[slot_of({p[0], p[1], p[2]})] = static_cast<std::uint32_t>(k);
  }
}

}  // namespace tessera
