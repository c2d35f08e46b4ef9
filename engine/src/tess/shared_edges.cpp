#include "tess/shared_edges.h"

#include <bit>

namespace tessera {
namespace {

/// A border's packed control points: `count` of them, `step` floats apart; component c lies PatchSet::lanes * c further.
struct Border {
  const float* first = nullptr;
  std::ptrdiff_t step = 0;
  int count = 0, components = 0;

  std::uint32_t bits(int point, int component) const {
    return std::bit_cast<std::uint32_t>(first[point * step + component * std::ptrdiff_t{PatchSet::lanes}]);
  }
};

Border border_of(const PatchSet::Impl& set, std::size_t patch, Side side) {
  const PatchSet::Slot slot = set.slots[patch];
  const BlockGroup& group = set.group_of_block(slot.block);
  const float* net = set.single.bernstein.data() + group.first_value +
                     (slot.block - group.first_block) * group.block_values + slot.lane;
  const int components = group.rational ? 4 : 3;
  const std::ptrdiff_t column = components * std::ptrdiff_t{PatchSet::lanes}, row = column * (group.degree_v + 1);
  if (runs_along_u(side))
    return {net + (side == Side::v1 ? column * group.degree_v : 0), row, group.degree_u + 1, components};
  return {net + (side == Side::u1 ? row * group.degree_u : 0), column, group.degree_v + 1, components};
}

bool equal(const Border& a, const Border& b, bool reversed) {
  if (a.count != b.count || a.components != b.components) return false;
  for (int k = 0; k < a.count; ++k)
    for (int c = 0; c < a.components; ++c)
      if (a.bits(k, c) != b.bits(reversed ? b.count - 1 - k : k, c)) return false;
  return true;
}

/// The finaliser of MurmurHash3 (Appleby 2011): every bit of x moves every bit of the result.
std::uint64_t mixed(std::uint64_t x) {
  x = (x ^ x >> 33) * 0xff51afd7ed558ccdULL;
  x = (x ^ x >> 33) * 0xc4ceb9fe1a85ec53ULL;
  return x ^ x >> 33;
}

/// The same for both directions: a sum over the points, each mixed with its distance to the nearer end.
std::uint64_t hash(const Border& border) {
  std::uint64_t sum = static_cast<std::uint64_t>(border.count * 8 + border.components);
  for (int k = 0; k < border.count; ++k) {
    auto point = static_cast<std::uint64_t>(std::min(k, border.count - 1 - k)) + 1;
    for (int c = 0; c < border.components; ++c) point = mixed(point ^ std::uint64_t{border.bits(k, c)} << 16);
    sum += point;
  }
  return mixed(sum);
}

}  // namespace

SharedEdges::SharedEdges(const PatchSet::Impl& set) : edges_(4 * set.patches.size(), none) {
  // Open addressing, at most half full; an entry is a border's number + 1.
  const std::size_t mask = std::bit_ceil(2 * edges_.size() + 1) - 1;
  std::vector<std::uint32_t> table(mask + 1, 0);
  for (std::size_t patch = 0; patch < set.patches.size(); ++patch)
    for (const Side side : all_sides) {
      if (set.collapsed[patch].has(edge_of(side))) continue;
      const Border border = border_of(set, patch, side);
      const std::size_t number = 4 * patch + static_cast<std::size_t>(side);
      std::size_t at = hash(border) & mask;
      for (; table[at] != 0; at = (at + 1) & mask) {
        const std::size_t other = table[at] - 1;
        const Border met = border_of(set, other / 4, all_sides[other % 4]);
        if (!equal(border, met, false) && !equal(border, met, true)) continue;
        edges_[number] = edges_[other];
        break;
      }
      if (table[at] != 0) continue;
      table[at] = static_cast<std::uint32_t>(number + 1);
      edges_[number] = static_cast<std::uint32_t>(count_++);
    }
}

}  // namespace tessera
