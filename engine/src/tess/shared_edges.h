#pragma once
// Which borders of the patches of a set are one curve.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "block/patch_set_impl.h"

namespace tessera {

/// The four borders of a patch, counter-clockwise around its parameters from (0,0): v = 0, u = 1, v = 1, u = 0.
enum class Side : std::uint8_t { v0, u1, v1, u0 };
inline constexpr std::array<Side, 4> all_sides{Side::v0, Side::u1, Side::v1, Side::u0};
constexpr bool runs_along_u(Side side) { return side == Side::v0 || side == Side::v1; }
constexpr Edge edge_of(Side side) {
  constexpr Edge edges[] = {Edge::v0, Edge::u1, Edge::v1, Edge::u0};
  return edges[static_cast<int>(side)];
}

/// A border's packed float control points, relative to the set's origin, homogeneous if there are 4 components; they run
/// with u or v. Patches scale their weights by powers of two, each its own: here they are scaled so that the border's
/// largest weight lies in [1/2, 1). The set must have float Bernstein blocks.
class PackedBorder {
 public:
  PackedBorder(const PatchSet::Impl& set, std::size_t patch, Side side) {
    const PatchSet::Slot slot = set.slots[patch];
    const BlockGroup& group = set.groups.size() == 1 ? set.groups.front() : set.group_of_block(slot.block);
    components_ = group.rational ? 4 : 3;
    const std::ptrdiff_t column = components_ * std::ptrdiff_t{PatchSet::lanes}, row = column * (group.degree_v + 1);
    first_ = set.single.bernstein.data() + group.first_value + (slot.block - group.first_block) * group.block_values +
             slot.lane +
             (side == Side::v1   ? column * group.degree_v
              : side == Side::u1 ? row * group.degree_u
                                 : 0);
    step_ = runs_along_u(side) ? row : column;
    count_ = (runs_along_u(side) ? group.degree_u : group.degree_v) + 1;
    if (group.rational) scale_ = weight_scale();
  }
  int count() const { return count_; }
  int components() const { return components_; }
  float scale() const { return scale_; }  ///< a power of two; 1 for polynomial patches
  /// The packed number itself, without the scale.
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

/// Whether borders are the same bits, the one running backwards if `reversed`.
bool equal(const PackedBorder& a, const PackedBorder& b, bool reversed);

/// The edges of a set: borders whose packed float control points and weights are the same bits, in either direction, are one edge. It
/// is these floats that get evaluated, so equal bits make equal curves. Borders of different degree are different edges.
/// Collapsed borders belong to none.
class SharedEdges {
 public:
  static constexpr std::uint32_t none = 0xffffffff;

  /// The set must have float Bernstein blocks. Edges are numbered by the first border of each, in the order of the
  /// patches and of `all_sides`.
  explicit SharedEdges(const PatchSet::Impl& set);

  std::size_t count() const { return count_; }
  std::uint32_t edge(std::size_t patch, Side side) const { return edges_[4 * patch + static_cast<std::size_t>(side)]; }
  /// Gives each edge another number, below count(), or none.
  void renumber(std::span<const std::uint32_t> numbers);

 private:
  std::vector<std::uint32_t> edges_;  ///< `[patch][side]`
  std::size_t count_ = 0;
};

}  // namespace tessera
