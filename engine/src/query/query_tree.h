#pragma once
// A tree of boxes over pieces, for queries by points: nodes of eight children, and blocks of up to eight pieces with
// boxes along axes of their own.

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "query/piece_facts.h"
#include "tessera/geometry.h"

namespace tessera { inline namespace abi_0_1 {

/// The boxes of a tree's item, in a scene's coordinates.
struct ItemBoxes {
  Box3 axis_box;
  PieceBox box;
};

/// Const calls from any number of threads.
class QueryTree {
 public:
  static constexpr std::size_t width = 8;

  /// Builds the tree over items 0 to items.size() - 1, fewer than 2^31 of them.
  void build(std::span<const ItemBoxes> items);
  /// Changes the boxes of some items, and those of all nodes.
  struct Change {
    std::uint32_t item;
    ItemBoxes boxes;
  };
  void refit(std::span<const Change> changes);
  /// Returns the items in the order of the tree: place -> item.
  std::span<const std::uint32_t> order() const { return order_; }
  std::size_t memory_bytes() const;

  /// Calls visit(item, distance) for items whose boxes are within visitor.reach() of a point, the nearer ones first.
  /// The distance is a lower bound; reach() may shrink meanwhile. Ends early if visit returns false.
  template <class Visitor>
  void visit_near(const Vec3& point, Visitor& visitor) const;

 private:
  struct alignas(32) Node {
    float lower[3][width], upper[3][width];
    std::uint32_t child[width];  ///< a node, a block with `block_bit`, or no_id
  };
  struct alignas(32) Block {
    float centre[3][width], axes[3][3][width], half[3][width];
    std::uint32_t first = 0, count = 0;  ///< a run of `order_`
  };
  static constexpr std::uint32_t block_bit = 0x80000000;
  /// Up to this distance from the middle of the scene, float is fine enough.
  static constexpr double max_float_distance = 16;
  static constexpr std::size_t max_stack = 256;

  struct Entry {
    double square;
    std::uint32_t child;
  };

  std::uint32_t build_part(std::span<const ItemBoxes> items, std::size_t begin, std::size_t end);
  std::uint32_t make_block(std::span<const ItemBoxes> items, std::size_t begin, std::size_t end);
  void set_box(Block& block, std::size_t lane, const PieceBox& box) const;
  static void set_child(Node& node, std::size_t lane, const Box3& box);
  Box3 box_of(std::uint32_t child) const;
  template <class Real>
  void squares_of(const Node& node, const Real (&point)[3], Real (&squares)[width]) const;
  void squares_of(const Block& block, const float (&point)[3], float (&squares)[width]) const;
  template <class Real, class Visitor>
  void visit_as(const Vec3& point, double margin, Visitor& visitor) const;
  template <class Real, class Visitor>
  bool visit_block(const Block& block, const Real (&point)[3], double margin, Visitor& visitor) const;

  std::vector<Node> nodes_;  ///< children behind their parents
  std::vector<Block> blocks_;
  std::vector<std::uint32_t> order_, place_of_;
  std::vector<std::array<float, 6>> item_boxes_;  ///< by places: lower, upper
  std::uint32_t root_ = 0;
};

template <class Real>
inline void QueryTree::squares_of(const Node& node, const Real (&point)[3], Real (&squares)[width]) const {
  for (std::size_t k = 0; k < width; ++k) squares[k] = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t k = 0; k < width; ++k) {
      const Real below = Real(node.lower[c][k]) - point[c], above = point[c] - Real(node.upper[c][k]);
      const Real larger = below > above ? below : above;
      const Real beyond = larger > 0 ? larger : 0;
      squares[k] += beyond * beyond;
    }
  }
}

inline void QueryTree::squares_of(const Block& block, const float (&point)[3], float (&squares)[width]) const {
  float from[3][width];
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t k = 0; k < width; ++k) from[c][k] = point[c] - block.centre[c][k];
  for (std::size_t k = 0; k < width; ++k) squares[k] = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t k = 0; k < width; ++k) {
      const float along =
          from[0][k] * block.axes[a][0][k] + from[1][k] * block.axes[a][1][k] + from[2][k] * block.axes[a][2][k];
      const float over = (along < 0 ? -along : along) - block.half[a][k];
      const float beyond = over > 0 ? over : 0;
      squares[k] += beyond * beyond;
    }
  }
}

template <class Real, class Visitor>
bool QueryTree::visit_block(const Block& block, const Real (&point)[3], double margin, Visitor& visitor) const {
  double squares[width];
  if constexpr (sizeof(Real) == sizeof(float)) {
    float narrow[width];
    squares_of(block, point, narrow);
    for (std::size_t k = 0; k < width; ++k) squares[k] = narrow[k];
  } else {
    for (std::size_t k = 0; k < block.count; ++k) {
      squares[k] = 0;
      for (std::size_t c = 0; c < 3; ++c) {
        const auto& box = item_boxes_[block.first + k];
        const double beyond = std::max({double(box[c]) - point[c], point[c] - double(box[c + 3]), 0.0});
        squares[k] += beyond * beyond;
      }
    }
  }
  unsigned left = (1u << block.count) - 1;
  while (left != 0) {
    const double reach = visitor.reach() + margin, limit = reach * reach;
    std::size_t nearest = width;
    double least = limit;
    for (std::size_t k = 0; k < block.count; ++k) {
      if ((left >> k & 1) != 0 && squares[k] <= least) least = squares[k], nearest = k;
    }
    if (nearest == width) return true;
    left &= ~(1u << nearest);
    const double distance = std::max(std::sqrt(least) - margin, 0.0);
    if (!visitor.visit(order_[block.first + nearest], distance)) return false;
  }
  return true;
}

template <class Real, class Visitor>
void QueryTree::visit_as(const Vec3& point, double margin, Visitor& visitor) const {
  const Real at[3] = {static_cast<Real>(point.x), static_cast<Real>(point.y), static_cast<Real>(point.z)};
  Entry stack[max_stack];
  std::size_t count = 0;
  stack[count++] = {0, root_};
  while (count > 0) {
    const Entry entry = stack[--count];
    double reach = visitor.reach() + margin;
    if (entry.square > reach * reach) continue;
    if ((entry.child & block_bit) != 0) {
      if (!visit_block(blocks_[entry.child & ~block_bit], at, margin, visitor)) return;
      continue;
    }
    const Node& node = nodes_[entry.child];
    Real squares[width];
    squares_of(node, at, squares);
    const std::size_t first = count;
    for (std::size_t k = 0; k < width; ++k) {
      if (!(double(squares[k]) <= reach * reach) || node.child[k] == no_id) continue;
      std::size_t place = count++;  // the farthest first, the nearest on top
      for (; place > first && stack[place - 1].square < double(squares[k]); --place) stack[place] = stack[place - 1];
      stack[place] = {double(squares[k]), node.child[k]};
    }
  }
}

template <class Visitor>
void QueryTree::visit_near(const Vec3& point, Visitor& visitor) const {
  if (order_.empty()) return;
  const double far = max_abs(point);
  if (far <= max_float_distance)
    visit_as<float>(point, 2e-6 * (1 + far), visitor);
  else
    visit_as<double>(point, 0x1p-50 * far, visitor);
}

}}  // namespace tessera::abi_0_1
