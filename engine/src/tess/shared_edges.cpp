#include "tess/shared_edges.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "kernel/kernel_table.h"

namespace tessera {
namespace {

std::uint32_t bits(const PackedBorder& border, int point, int component) {
  return std::bit_cast<std::uint32_t>(border.value(point, component));
}

/// Of all borders, `[block][side][lane]`: the same for borders that are equal(), in either direction.
std::vector<std::uint32_t> hashes_of(const PatchSet::Impl& set) {
  std::vector<std::uint32_t> hashes(set.lane_counts.size() * 4 * PatchSet::lanes);
  const kernel::KernelTable& kernels = kernel::default_kernels();
  for (const BlockGroup& group : set.groups)
    for (std::size_t block = 0; block < group.block_count; ++block)
      kernels.hash_borders({.net = set.single.bernstein.data() + group.first_value + block * group.block_values,
                            .degree_u = group.degree_u,
                            .degree_v = group.degree_v,
                            .rational = group.rational,
                            .hash = hashes.data() + (group.first_block + block) * 4 * PatchSet::lanes});
  return hashes;
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
  // Open addressing, at most four fifths full. A border's number + 1, and the hash, which is compared before the border.
  struct Entry {
    std::uint32_t hash = 0, border = 0;
  };
  const std::size_t mask = std::bit_ceil(edges_.size() + edges_.size() / 4 + 1) - 1;
  std::vector<Entry> table(mask + 1);
  const std::vector<std::uint32_t> hashes = hashes_of(set);
  const auto hash_of = [&](std::size_t patch, std::size_t side) {
    const PatchSet::Slot slot = set.slots[patch];
    return hashes[(std::size_t{slot.block} * 4 + side) * PatchSet::lanes + slot.lane];
  };
  constexpr std::size_t ahead = 8;  // patches, from a fetch to its use
  for (std::size_t patch = 0; patch < set.patches.size(); ++patch) {
    if (patch + ahead < set.patches.size())
      for (std::size_t side = 0; side < 4; ++side) __builtin_prefetch(&table[hash_of(patch + ahead, side) & mask]);
    for (const Side side : all_sides) {
      if (set.collapsed[patch].has(edge_of(side))) continue;
      const std::size_t number = 4 * patch + static_cast<std::size_t>(side);
      const std::uint32_t hash = hash_of(patch, static_cast<std::size_t>(side));
      std::size_t at = hash & mask;
      for (; table[at].border != 0; at = (at + 1) & mask) {
        if (table[at].hash != hash) continue;
        const std::size_t other = table[at].border - 1;
        const PackedBorder border(set, patch, side), met(set, other / 4, all_sides[other % 4]);
        if (!equal(border, met, false) && !equal(border, met, true)) continue;
        edges_[number] = edges_[other];
        break;
      }
      if (table[at].border != 0) continue;
      table[at] = {hash, static_cast<std::uint32_t>(number + 1)};
      edges_[number] = static_cast<std::uint32_t>(count_++);
    }
  }
}

void SharedEdges::renumber(std::span<const std::uint32_t> numbers) {
  for (std::uint32_t& edge : edges_)
    if (edge != none) edge = numbers[edge];
}

}  // namespace tessera
