#include "io/mesh/vertex_welder.h"

#include "tess/edges/position_bits.h"

namespace tessera { inline namespace abi_0_1 {

std::size_t VertexWelder::slot_of(const std::array<float, 3>& position) const {
  const PositionBits bits = position_bits(position.data());
  std::size_t slot = hash(bits) & (table_.size() - 1);
  while (table_[slot] != no_id && position_bits(&positions_[3 * std::size_t{table_[slot]}]) != bits)
    slot = (slot + 1) & (table_.size() - 1);
  return slot;
}

std::uint32_t VertexWelder::index_of(const std::array<float, 3>& position) {
  const std::size_t slot = slot_of(position);
  if (table_[slot] != no_id) return table_[slot];
  const std::size_t index = positions_.size() / 3;
  table_[slot] = static_cast<std::uint32_t>(index);
  positions_.insert(positions_.end(), position.begin(), position.end());
  if (2 * (index + 1) > table_.size()) grow();
  return static_cast<std::uint32_t>(index);
}

void VertexWelder::grow() {
  const std::size_t vertices = positions_.size() / 3;
  table_.assign(2 * table_.size(), no_id);
  for (std::size_t k = 0; k < vertices; ++k) {
    const float* const p = &positions_[3 * k];
    table_[slot_of({p[0], p[1], p[2]})] = static_cast<std::uint32_t>(k);
  }
}

}}  // namespace tessera::abi_0_1
