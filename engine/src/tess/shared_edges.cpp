#include "tess/shared_edges.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace tessera {
namespace {

std::uint32_t bits(const PackedBorder& border, int point, int component) {
  return std::bit_cast<std::uint32_t>(border.value(point, component));
}

/// The finaliser of MurmurHash3 (Appleby 2011): every bit of x moves every bit of the result.
std::uint64_t mixed(std::uint64_t x) {
  x = (x ^ x >> 33) * 0xff51afd7ed558ccdULL;
  x = (x ^ x >> 33) * 0xc4ceb9fe1a85ec53ULL;
  return x ^ x >> 33;
}

/// The same for both directions: a sum over the points, each mixed with its distance to the nearer end.
std::uint64_t hash(const PackedBorder& border) {
  std::uint64_t sum = static_cast<std::uint64_t>(border.count() * 8 + border.components());
  for (int k = 0; k < border.count(); ++k) {
    auto point = static_cast<std::uint64_t>(std::min(k, border.count() - 1 - k)) + 1;
    for (int c = 0; c < border.components(); ++c) point = mixed(point ^ std::uint64_t{bits(border, k, c)} << 16);
    sum += point;
  }
  return mixed(sum);
}

}  // namespace

bool equal(const PackedBorder& a, const PackedBorder& b, bool reversed) {
  if (a.count() != b.count() || a.components() != b.components()) return false;
  for (int k = 0; k < a.count(); ++k)
    for (int c = 0; c < a.components(); ++c)
      if (bits(a, k, c) != bits(b, reversed ? b.count() - 1 - k : k, c)) return false;
  return true;
}

PackedBorder::PackedBorder(const PatchSet::Impl& set, std::size_t patch, Side side) {
  const PatchSet::Slot slot = set.slots[patch];
  const BlockGroup& group = set.group_of_block(slot.block);
  first_ = set.single.bernstein.data() + group.first_value + (slot.block - group.first_block) * group.block_values +
           slot.lane;
  components_ = group.rational ? 4 : 3;
  const std::ptrdiff_t column = components_ * std::ptrdiff_t{PatchSet::lanes}, row = column * (group.degree_v + 1);
  if (runs_along_u(side)) {
    first_ += side == Side::v1 ? column * group.degree_v : 0;
    step_ = row;
    count_ = group.degree_u + 1;
  } else {
    first_ += side == Side::u1 ? row * group.degree_u : 0;
    step_ = column;
    count_ = group.degree_v + 1;
  }
  if (!group.rational) return;
  float heaviest = 0;
  for (int k = 0; k < count_; ++k) heaviest = std::max(heaviest, value(k, 3));
  scale_ = std::ldexp(1.0f, -std::ilogb(heaviest) - 1);
}

SharedEdges::SharedEdges(const PatchSet::Impl& set) : edges_(4 * set.patches.size(), none) {
  // Open addressing, at most half full; an entry is a border's number + 1.
  const std::size_t mask = std::bit_ceil(2 * edges_.size() + 1) - 1;
  std::vector<std::uint32_t> table(mask + 1, 0);
  for (std::size_t patch = 0; patch < set.patches.size(); ++patch)
    for (const Side side : all_sides) {
      if (set.collapsed[patch].has(edge_of(side))) continue;
      const PackedBorder border(set, patch, side);
      const std::size_t number = 4 * patch + static_cast<std::size_t>(side);
      std::size_t at = hash(border) & mask;
      for (; table[at] != 0; at = (at + 1) & mask) {
        const std::size_t other = table[at] - 1;
        const PackedBorder met(set, other / 4, all_sides[other % 4]);
        if (!equal(border, met, false) && !equal(border, met, true)) continue;
        edges_[number] = edges_[other];
        break;
      }
      if (table[at] != 0) continue;
      table[at] = static_cast<std::uint32_t>(number + 1);
      edges_[number] = static_cast<std::uint32_t>(count_++);
    }
}

void SharedEdges::renumber(std::span<const std::uint32_t> numbers) {
  for (std::uint32_t& edge : edges_)
    if (edge != none) edge = numbers[edge];
}

}  // namespace tessera
