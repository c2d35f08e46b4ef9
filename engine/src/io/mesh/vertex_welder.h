#pragma once
// Makes vertices of the corners of triangles, each of which has its own copy of the position.

#include <array>
#include <cstdint>
#include <vector>

namespace tessera { inline namespace abi_0_1 {

/// Numbers distinct positions in the order in which they come. Positions are equal if their bits are, with -0 taken as
/// 0. Memory: 4 to 16 bytes per vertex besides the positions.
class VertexWelder {
 public:
  /// New positions are appended to `positions`: three floats per vertex, at most 2^32 - 1 vertices.
  explicit VertexWelder(std::vector<float>& positions) : positions_(positions), table_(min_size, no_id) {}

  std::uint32_t index_of(const std::array<float, 3>& position);

 private:
  static constexpr std::size_t min_size = 64;  // a power of two, like all sizes

  std::size_t slot_of(const std::array<float, 3>& position) const;
  void grow();

  std::vector<float>& positions_;
  std::vector<std::uint32_t> table_;  // open hash table of vertices
};

}}  // namespace tessera::abi_0_1
