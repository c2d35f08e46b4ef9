#include "tess/edges/shared_edges.h"

#include <algorithm>
#include <bit>

#include "kernel/table/kernel_table.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// equal() for borders of `count` points each, of three or four components.
template <int Components>
bool is_equal(const PackedBorder& a, const PackedBorder& b, int count, bool reversed) {
  const auto bits = [](const PackedBorder& border, int point, int component) {
    return std::bit_cast<std::uint32_t>(Components == 3 ? border.packed(point, component)
                                                        : border.value(point, component));
  };
  const int last = count - 1;
  const auto differ = [&](int k, int c) { return bits(a, k, c) ^ bits(b, reversed ? last - k : k, c); };
  if (differ(0, 0)) return false;  // most borders that differ do so here
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

/// Borders by their hashes, with open addressing. At most half full: a probe that fails takes longest, and half of all
/// fail.
class BorderTable {
 public:
  /// Makes room for about two edges per patch, as there are where most borders are those of two patches.
  explicit BorderTable(std::size_t patches) : entries_(std::bit_ceil(5 * patches + 1)), mask_(entries_.size() - 1) {}

  void fetch(std::uint32_t hash) const { __builtin_prefetch(&entries_[hash & mask_]); }
  /// Returns a border in the table with that hash for which `is_same` holds. If there is none, adds `border` and
  /// returns it.
  template <class IsSame>
  std::size_t find_or_add(std::uint32_t hash, std::uint32_t border, const IsSame& is_same) {
    std::size_t at = hash & mask_;
    for (; entries_[at].border != 0; at = (at + 1) & mask_)
      if (entries_[at].hash == hash && is_same(entries_[at].border - 1)) return entries_[at].border - 1;
    entries_[at] = {hash, border + 1};
    if (2 * ++count_ > entries_.size()) grow();
    return border;
  }

 private:
  struct Entry {
    std::uint32_t hash = 0, border = 0;  ///< border: its number + 1; 0: none
  };

  [[gnu::noinline]] void grow() {
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
constexpr std::size_t lanes = PatchSet::lanes;

/// Gives each border its edge, block after block.
class EdgeFinder {
 public:
  EdgeFinder(const PatchSet::Impl& set, const BorderHashes& hashes, std::span<std::uint32_t> edges)
      : set_(set), hashes_(hashes), edges_(edges), table_(set.patches.size()) {
    only_borders_.reserve(2 * set.patches.size() + set.patches.size() / 4);
  }

  void add(const BlockGroup& group, std::size_t block) {
    const std::uint32_t *const hashes = hashes_.of_block(block), *const patches = patches_of(block);
    const std::size_t count = set_.lane_counts[block];
    for (const Side side : all_sides) {
      const auto s = static_cast<std::size_t>(side);
      met_[s].fill(no_id);
      if (back_[s] > 0) look_back(group, block, side);
      for (std::size_t lane = 0; lane < count; ++lane)
        if (met_[s][lane] == no_id) table_.fetch(hashes[s * lanes + lane]);
    }
    for (std::size_t lane = 0; lane < count; ++lane) {
      const std::size_t patch = patches[lane];
      const SideMask collapsed = set_.collapsed[patch];
      const auto add_side = [&](Side side) {
        const auto s = static_cast<std::size_t>(side);
        const std::uint32_t met = met_[s][lane];
        if (collapsed.has(side)) return;
        if (met != no_id && edges_[met] != no_id)
          join(4 * patch + s, met);
        else
          find(4 * patch + s, side, hashes[s * lanes + lane]);
      };
      add_side(Side::v0), add_side(Side::u1), add_side(Side::v1), add_side(Side::u0);
    }
  }
  std::vector<std::uint32_t> take_only_borders() { return std::move(only_borders_); }

 private:
  const std::uint32_t* patches_of(std::size_t block) const { return set_.lane_patches.data() + block * lanes; }

  /// Gives a border the edge of one with the same hash that is the same, or a new one.
  [[gnu::noinline]] void find(std::size_t number, Side side, std::uint32_t hash) {
    const auto is_same = [&](std::size_t other) { return this->is_same(number, other); };
    const std::size_t first = table_.find_or_add(hash, static_cast<std::uint32_t>(number), is_same);
    if (first == number) {
      edges_[number] = static_cast<std::uint32_t>(only_borders_.size());
      only_borders_.push_back(static_cast<std::uint32_t>(number));
    } else {
      join(number, first);
    }
    if (first < number) back_[static_cast<std::size_t>(side)] = number - first;
  }
  [[gnu::noinline]] bool is_same(std::size_t number, std::size_t other) const {
    const PackedBorder border(set_, number / 4, all_sides[number % 4]), found(set_, other / 4, all_sides[other % 4]);
    return is_equal(border, found, false) || is_equal(border, found, true);
  }
  /// Gives a border the edge of another.
  void join(std::size_t number, std::size_t other) {
    const std::uint32_t edge = edges_[number] = edges_[other];
    only_borders_[edge] = no_id;
  }

  /// Fills met_ with borders that are equal to the block's own. In rows of patches the next edge of a side is met as
  /// many borders back as the last one was, so the block's borders are compared, all at once, with those so far back.
  void look_back(const BlockGroup& group, std::size_t block, Side side) {
    const auto s = static_cast<std::size_t>(side);
    const std::size_t back = back_[s];
    const std::size_t other_side = (s - back) % 4;
    const BorderPlaces own(group, side), other(group, all_sides[other_side]);
    if (own.count != other.count) return;
    const auto start_of = [&](std::size_t at) {
      return static_cast<std::ptrdiff_t>((at - group.first_block) * group.block_values);
    };
    const std::uint32_t *const hashes = hashes_.of_block(block) + s * lanes, *const patches = patches_of(block);
    std::array<std::uint32_t, lanes> numbers;
    std::array<std::int32_t, lanes> places{};
    bool any = false;
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const std::size_t number = 4 * std::size_t{patches[lane]} + s;
      numbers[lane] = no_id;
      if (back > number) continue;
      const PatchSet::Slot slot = set_.slots[(number - back) / 4];
      if (slot.block < group.first_block || slot.block > block || hashes_.of(slot, other_side) != hashes[lane])
        continue;
      const std::ptrdiff_t place = start_of(slot.block) - start_of(block) + slot.lane;
      if (place < -max_away) continue;
      numbers[lane] = static_cast<std::uint32_t>(number - back);
      places[lane] = static_cast<std::int32_t>(place);
      any = true;
    }
    if (!any) return;
    const float* const net = set_.f32.bernstein.data() + group.first_value + start_of(block);
    for (const bool reversed : {false, true}) {
      std::array<std::uint32_t, lanes> differing;
      kernels_.match_borders({.first = net + own.first,
                              .step = own.step,
                              .count = own.count,
                              .components = own.components,
                              .others = net + other.first + (reversed ? (other.count - 1) * other.step : 0),
                              .place = places.data(),
                              .other_step = reversed ? -other.step : other.step,
                              .differing = differing.data()});
      any = false;
      for (std::size_t lane = 0; lane < lanes; ++lane) {
        if (differing[lane] == 0 && met_[s][lane] == no_id) met_[s][lane] = numbers[lane];
        any |= numbers[lane] != met_[s][lane];
      }
      if (!any) return;
    }
  }
  static constexpr std::ptrdiff_t max_away = std::ptrdiff_t{1} << 30;  // in floats

  const PatchSet::Impl& set_;
  const BorderHashes& hashes_;
  const kernel::KernelTable& kernels_ = kernel::default_kernels();
  std::span<std::uint32_t> edges_;
  BorderTable table_;
  std::array<std::size_t, 4> back_{};  ///< `[side]`: how many borders back its last edge was met; 0: none was met
  /// `[side][lane]`: a border equal() to the block's own, or none.
  std::array<std::array<std::uint32_t, lanes>, 4> met_;
  std::vector<std::uint32_t> only_borders_;  ///< `[edge]`: its border, or none if it has more
};

}  // namespace

bool equal(const PackedBorder& a, const PackedBorder& b, bool reversed) { return is_equal(a, b, reversed); }

float PackedBorder::weight_scale() const {
  float heaviest = 0;
  for (int k = 0; k < count_; ++k) heaviest = std::max(heaviest, packed(k, 3));
  // Returns 2^-k for a weight of at least 2^(k-1) and below 2^k; packed weights are far from the ends of float's range.
  return std::bit_cast<float>((253u - (std::bit_cast<std::uint32_t>(heaviest) >> 23)) << 23);
}

BorderHashes::BorderHashes(const PatchSet::Impl& set)
    : kernels_(&kernel::default_kernels()), hashes_(set.lane_counts.size() * 4 * PatchSet::lanes) {}

void BorderHashes::find(const PatchSet::Impl& set, std::size_t block) {
  const BlockGroup& group = set.group_of_block(block);
  kernels_->hash_borders(
      {.net = set.f32.bernstein.data() + group.first_value + (block - group.first_block) * group.block_values,
       .degree_u = group.degree_u,
       .degree_v = group.degree_v,
       .rational = group.rational,
       .hash = hashes_.data() + block * 4 * lanes});
}

SharedEdges::SharedEdges(const PatchSet::Impl& set, const BorderHashes& hashes,
                         std::vector<std::uint32_t>* only_borders)
    : edges_(4 * set.patches.size(), no_id) {
  EdgeFinder finder(set, hashes, edges_);
  for (const BlockGroup& group : set.groups)
    for (std::size_t block = 0; block < group.block_count; ++block) finder.add(group, group.first_block + block);
  std::vector<std::uint32_t> found = finder.take_only_borders();
  count_ = found.size();
  if (only_borders) *only_borders = std::move(found);
}

void SharedEdges::renumber(std::span<const std::uint32_t> numbers) {
  for (std::uint32_t& edge : edges_)
    if (edge != no_id) edge = numbers[edge];
}

}}  // namespace tessera::abi_0_1
