#include "tess/shared_edges.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "kernel/kernel_table.h"

namespace tessera {
namespace {

/// equal(), for borders of as many points, of three components or four.
template <int Components>
bool is_equal(const PackedBorder& a, const PackedBorder& b, int count, bool reversed) {
  const auto bits = [](const PackedBorder& border, int point, int component) {
    return std::bit_cast<std::uint32_t>(Components == 3 ? border.packed(point, component)
                                                        : border.value(point, component));
  };
  const int last = count - 1;
  const auto differ = [&](int k, int c) { return bits(a, k, c) ^ bits(b, reversed ? last - k : k, c); };
  if (differ(0, 0)) return false;  // as most that differ do
  std::uint32_t differing = 0;
  for (int k = 0; k < count; ++k)
    for (int c = 0; c < Components; ++c) differing |= differ(k, c);
  return differing == 0;
}

bool is_equal(const PackedBorder& a, const PackedBorder& b, bool reversed) {
  const int count = a.count(), components = a.components();
  if (count != b.count() || components != b.components()) return false;
  if (components != 3) return is_equal<4>(a, b, count, reversed);
  return count == 4 ? is_equal<3>(a, b, 4, reversed) : is_equal<3>(a, b, count, reversed);
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

/// Borders by their hashes: open addressing, at most four fifths full.
class BorderTable {
 public:
  /// Where most borders are those of two patches there are about two edges a patch.
  explicit BorderTable(std::size_t patches) : entries_(std::bit_ceil(3 * patches + 1)), mask_(entries_.size() - 1) {}

  void fetch(std::uint32_t hash) const { __builtin_prefetch(&entries_[hash & mask_]); }
  /// A border of that hash that `is_same`, or this one, which is there from then on.
  template <class IsSame>
  std::size_t find_or_add(std::uint32_t hash, std::uint32_t border, const IsSame& is_same) {
    std::size_t at = hash & mask_;
    for (; entries_[at].border != 0; at = (at + 1) & mask_)
      if (entries_[at].hash == hash && is_same(entries_[at].border - 1)) return entries_[at].border - 1;
    entries_[at] = {hash, border + 1};
    if (5 * ++count_ > 4 * entries_.size()) grow();
    return border;
  }

 private:
  struct Entry {
    std::uint32_t hash = 0, border = 0;  ///< the number of the border + 1; 0: none
  };

  void grow() {
    const std::vector<Entry> entries(std::exchange(entries_, std::vector<Entry>(2 * entries_.size())));
    mask_ = entries_.size() - 1;
    for (const Entry& entry : entries) {
      if (entry.border == 0) continue;
      std::size_t at = entry.hash & mask_;
      while (entries_[at].border != 0) at = (at + 1) & mask_;
      entries_[at] = entry;
    }
  }

  std::vector<Entry> entries_;
  std::size_t mask_, count_ = 0;
};

}  // namespace

bool equal(const PackedBorder& a, const PackedBorder& b, bool reversed) { return is_equal(a, b, reversed); }

float PackedBorder::weight_scale() const {
  float heaviest = 0;
  for (int k = 0; k < count_; ++k) heaviest = std::max(heaviest, packed(k, 3));
  return std::ldexp(1.0f, -std::ilogb(heaviest) - 1);
}

SharedEdges::SharedEdges(const PatchSet::Impl& set) : edges_(4 * set.patches.size(), none) {
  const std::vector<std::uint32_t> hashes = hashes_of(set);
  const auto hashes_of_patch = [&](std::size_t patch) {
    const PatchSet::Slot slot = set.slots[patch];
    return hashes.data() + std::size_t{slot.block} * 4 * PatchSet::lanes + slot.lane;
  };
  BorderTable table(set.patches.size());
  constexpr std::size_t ahead = 8;  // patches, from a fetch to its use
  std::array<std::size_t, 4>
      before{};  // how far back the last edge of each side was met: in rows of patches, so is the next
  for (std::size_t patch = 0; patch < set.patches.size(); ++patch) {
    if (patch + ahead < set.patches.size()) {
      const std::uint32_t* next = hashes_of_patch(patch + ahead);
      for (std::size_t side = 0; side < 4; ++side) table.fetch(next[side * PatchSet::lanes]);
    }
    const EdgeMask collapsed = set.collapsed[patch];
    const std::uint32_t* own = hashes_of_patch(patch);
    for (const Side side : all_sides) {
      if (collapsed.has(edge_of(side))) continue;
      const auto s = static_cast<std::size_t>(side), number = 4 * patch + s;
      const std::uint32_t hash = own[s * PatchSet::lanes];
      const auto is_same = [&](std::size_t other) {
        const PackedBorder border(set, patch, side), met(set, other / 4, all_sides[other % 4]);
        return is_equal(border, met, false) || is_equal(border, met, true);
      };
      std::size_t first = number - before[s];
      if (!(first < number && hashes_of_patch(first / 4)[first % 4 * PatchSet::lanes] == hash &&
            edges_[first] != none && is_same(first)))
        first = table.find_or_add(hash, static_cast<std::uint32_t>(number), is_same);
      edges_[number] = first == number ? static_cast<std::uint32_t>(count_++) : edges_[first];
      if (first != number) before[s] = number - first;
    }
  }
}

void SharedEdges::renumber(std::span<const std::uint32_t> numbers) {
  for (std::uint32_t& edge : edges_)
    if (edge != none) edge = numbers[edge];
}

}  // namespace tessera
