#pragma once
// Finds the borders of a set's patches that are one curve.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "block/patch_set_impl.h"
#include "tess/cells/patch_side.h"

namespace tessera { inline namespace abi_0_1 {

/// Where the control points of a side lie in a block, counted in floats.
struct BorderPlaces {
  std::ptrdiff_t first, step;
  int count, components;

  BorderPlaces(const BlockGroup& group, Side side) : components(group.rational ? 4 : 3) {
    const std::ptrdiff_t column = components * std::ptrdiff_t{PatchSet::lanes}, row = column * (group.degree_v + 1);
    first = side == Side::v1 ? column * group.degree_v : side == Side::u1 ? row * group.degree_u : 0;
    step = runs_along_u(side) ? row : column;
    count = degree_along(side, group) + 1;
  }
};

/// A border's packed float control points, relative to the set's origin, homogeneous if there are 4 components. They
/// run in the direction of u or v. Each patch scales its weights by its own power of two; here they are scaled so that
/// the border's largest weight lies in [1/2, 1). The set must have float Bernstein blocks.
class PackedBorder {
 public:
  PackedBorder(const PatchSet::Impl& set, std::size_t patch, Side side) {
    const PatchSet::Slot slot = set.slots[patch];
    const BlockGroup& group = set.groups.size() == 1 ? set.groups.front() : set.group_of_block(slot.block);
    const BorderPlaces places(group, side);
    components_ = places.components;
    first_ = set.f32.bernstein.data() + group.first_value + (slot.block - group.first_block) * group.block_values +
             slot.lane + places.first;
    step_ = places.step;
    count_ = places.count;
    if (group.rational) scale_ = weight_scale();
  }
  int count() const { return count_; }
  int components() const { return components_; }
  float scale() const { return scale_; }  ///< a power of two; 1 for polynomial patches
  /// Returns the packed number itself, without the scale.
  float packed(int point, int component) const {
    return first_[point * step_ + component * std::ptrdiff_t{PatchSet::lanes}];
  }
  float value(int point, int component) const { return scale_ * packed(point, component); }

 private:
  float weight_scale() const;

  float scale_ = 1;
  const float* first_;
  std::ptrdiff_t step_;
  int count_, components_;
};

/// Whether two borders are the same bits; if `reversed`, with one of them backwards.
bool equal(const PackedBorder& a, const PackedBorder& b, bool reversed);

/// Hashes of all borders of a set. Borders that are equal(), in either direction, have the same hash.
class BorderHashes {
 public:
  /// The set must have float Bernstein blocks.
  explicit BorderHashes(const PatchSet::Impl& set);
  /// Finds the hashes of a block. Threads: any number, each with its own block.
  void find(const PatchSet::Impl& set, std::size_t block);

  /// Returns the hashes of a block, `[side][lane]`, after find().
  const std::uint32_t* of_block(std::size_t block) const { return hashes_.data() + block * 4 * PatchSet::lanes; }
  std::uint32_t of(PatchSet::Slot slot, std::size_t side) const {
    return of_block(slot.block)[side * PatchSet::lanes + slot.lane];
  }

 private:
  const kernel::KernelTable* kernels_;
  UnsetVector<std::uint32_t> hashes_;
};

/// The edges of a set: borders whose packed float control points and weights are the same bits, in either direction,
/// are one edge. These floats are what is evaluated, so equal bits make equal curves. Borders of different degrees are
/// different edges. Collapsed borders belong to no edge.
class SharedEdges {
 public:
  SharedEdges() = default;
  /// Finds the edges. They are numbered in the order of their first borders: by blocks, by patches, and by `all_sides`.
  /// `only_borders`: gets WeldRules::only_borders, unless null.
  SharedEdges(const PatchSet::Impl& set, const BorderHashes& hashes,
              std::vector<std::uint32_t>* only_borders = nullptr);
  /// `edges` by 4 * patch + side, below `count` or none.
  SharedEdges(std::vector<std::uint32_t> edges, std::size_t count) : edges_(std::move(edges)), count_(count) {}

  std::size_t count() const { return count_; }
  std::uint32_t edge(std::size_t patch, Side side) const { return edges_[4 * patch + static_cast<std::size_t>(side)]; }
  std::span<const std::uint32_t> of_borders() const { return edges_; }  ///< by 4 * patch + side
  /// Gives each edge a new number, below count(), or none.
  void renumber(std::span<const std::uint32_t> numbers);

 private:
  std::vector<std::uint32_t> edges_;  ///< `[patch][side]`
  std::size_t count_ = 0;
};

}}  // namespace tessera::abi_0_1
