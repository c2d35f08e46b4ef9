#pragma once
// A tree of boxes over pieces, for queries by points: nodes of eight children, and blocks of up to eight pieces with
// boxes along axes of their own.

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "base/infinity.h"
#include "kernel/ray/nearest_kernels.h"
#include "query/piece_facts.h"
#include "tessera/geometry.h"

namespace tessera { inline namespace abi_0_1 {

/// Asks for memory, so that it is in the caches when it is read.
inline void fetch(const void* from, std::size_t bytes) {
  constexpr std::uintptr_t line = 64;
  const auto begin = reinterpret_cast<std::uintptr_t>(from), end = begin + bytes;
  for (std::uintptr_t at = begin & ~(line - 1); at < end; at += line)
    __builtin_prefetch(reinterpret_cast<const void*>(at));
}

/// The boxes of a tree's item, in a scene's coordinates.
struct ItemBoxes {
  Box3 axis_box;
  PieceBox box;
};

/// Const calls from any number of threads.
class QueryTree {
 public:
  static constexpr std::size_t width = kernel::NodeBoxes::size;

  /// Builds the tree over items 0 to items.size() - 1, fewer than 2^31 of them.
  void build(std::span<const ItemBoxes> items);
  /// Changes the boxes of some items, and those of all nodes.
  struct Change {
    std::uint32_t item;
    ItemBoxes boxes;
  };
  void refit(std::span<const Change> changes);
  std::size_t memory_bytes() const;

  /// The way of a search through the tree.
  class Path;
  /// Begins a search at the block whose boxes are the nearest to a point, which it fetches into the caches.
  void begin(const kernel::NearestKernels& kernels, const Vec3& point, Path& path) const;
  /// Returns the item of the block at which a search begins whose box is the nearest to the point, or no_id.
  std::uint32_t nearest_item(Path& path) const;
  /// Calls visit(item, distance) for items whose boxes are within visitor.reach() of the point of a path that has
  /// begun, the nearer ones first. The distance is a lower bound; reach() may shrink meanwhile. Ends early if visit
  /// returns false.
  template <class Visitor>
  void visit_near(Path& path, Visitor& visitor) const;

 private:
  struct Node {
    kernel::NodeBoxes boxes;
    std::uint32_t child[width];  ///< a node, a block with `block_bit`, or no_id
  };
  struct Block {
    kernel::BlockBoxes boxes;
    std::uint32_t item[width];  ///< or no_id, with a box that no point is near to
  };
  static constexpr std::uint32_t block_bit = 0x80000000;
  /// Up to this distance from the middle of the scene, float is fine enough.
  static constexpr double max_float_distance = 16;
  /// More than there are: a part of n items has parts of n / 8 + 14 at most.
  static constexpr std::size_t max_depth = 24;

  std::uint32_t build_part(std::span<const ItemBoxes> items, std::span<std::uint32_t> order);
  std::uint32_t make_block(std::span<const ItemBoxes> items, std::span<const std::uint32_t> order);
  void set_item(std::size_t place, const ItemBoxes& boxes, std::uint32_t item);
  static void set_child(Node& node, std::size_t lane, const Box3& box);
  Box3 box_of(std::uint32_t child) const;
  /// The squared distances in float by kernels, or in double.
  struct FloatSquares;
  struct DoubleSquares;
  template <class Squares>
  struct Level;
  template <class Squares>
  struct Way;
  template <class Squares>
  void start(Way<Squares>& way) const;
  template <class Squares>
  bool next_block(Way<Squares>& way, double limit) const;
  template <class Squares, class Visitor>
  void visit_by(Way<Squares>& way, double margin, Visitor& visitor) const;

  std::vector<Node> nodes_;  ///< children behind their parents
  std::vector<Block> blocks_;
  std::vector<std::uint32_t> place_of_;           ///< `[item]`: block times width, and the lane
  std::vector<std::array<float, 6>> item_boxes_;  ///< `[item]`: lower, upper
  std::uint32_t root_ = no_id;
};

struct QueryTree::FloatSquares {
  using Real = float;
  const kernel::NearestKernels* kernels;
  float at[3];

  unsigned operator()(const Node& node, double limit, float (&squares)[width]) const {
    return kernels->node_squares(node.boxes, at, rounded_up(limit), squares);
  }
  unsigned operator()(const Block& block, double limit, float (&squares)[width]) const {
    return kernels->block_squares(block.boxes, at, rounded_up(limit), squares);
  }

 private:
  /// Finite, so that places without a box are never near.
  static float rounded_up(double limit) {
    return static_cast<float>(std::min(limit * (1 + 0x1p-22), double(std::numeric_limits<float>::max())));
  }
};

struct QueryTree::DoubleSquares {
  using Real = double;
  const std::array<float, 6>* item_boxes;
  Vec3 at;

  unsigned operator()(const Node& node, double limit, double (&squares)[width]) const {
    unsigned near = 0;
    for (std::size_t k = 0; k < width && node.child[k] != no_id; ++k) {
      squares[k] = 0;
      for (std::size_t c = 0; c < 3; ++c) squares[k] += beyond(node.boxes.lower[c][k], node.boxes.upper[c][k], c);
      near |= unsigned{squares[k] <= limit} << k;
    }
    return near;
  }
  unsigned operator()(const Block& block, double limit, double (&squares)[width]) const {
    unsigned near = 0;
    for (std::size_t k = 0; k < width && block.item[k] != no_id; ++k) {
      const std::array<float, 6>& box = item_boxes[block.item[k]];
      squares[k] = 0;
      for (std::size_t c = 0; c < 3; ++c) squares[k] += beyond(box[c], box[c + 3], c);
      near |= unsigned{squares[k] <= limit} << k;
    }
    return near;
  }

 private:
  double beyond(double lower, double upper, std::size_t axis) const {
    const double x = axis == 0 ? at.x : axis == 1 ? at.y : at.z, out = std::max({lower - x, x - upper, 0.0});
    return out * out;
  }
};

/// The boxes of a node or a block that are left to be looked at.
template <class Squares>
struct QueryTree::Level {
  typename Squares::Real squares[width];
  const std::uint32_t* content = nullptr;  ///< children of a node, or items of a block
  unsigned left = 0;

  template <class Boxes>
  void start(const Squares& squares_of, const Boxes& boxes, const std::uint32_t (&of)[width], double limit) {
    content = of;
    left = squares_of(boxes, limit, squares);
  }
  /// Returns the place of the nearest of what is left, which must not be nothing.
  std::size_t nearest() const {
    auto lane = static_cast<std::size_t>(std::countr_zero(left));
    for (unsigned rest = left & (left - 1); rest != 0; rest &= rest - 1)
      if (const auto k = static_cast<std::size_t>(std::countr_zero(rest)); squares[k] < squares[lane]) lane = k;
    return lane;
  }
  /// Takes the nearest of what is left within a limit. Returns false if there is none, and then nothing is left.
  bool take(double limit, std::size_t& lane) {
    if (left == 0) return false;
    lane = nearest();
    const bool is_near = squares[lane] <= limit;
    left = is_near ? left & ~(1u << lane) : 0;
    return is_near;
  }
};

template <class Squares>
struct QueryTree::Way {
  Squares squares_of;
  std::size_t depth = 0;
  std::uint32_t block = no_id;  ///< where the way is
  Level<Squares> in_block;      ///< of the block, once it has begun
  Level<Squares> levels[max_depth];
};

class QueryTree::Path {
  friend class QueryTree;
  Vec3 point_;
  double far_ = 0;  ///< the distance of the point from the middle of the scene, at most
  Way<FloatSquares> way_;
};

template <class Squares>
void QueryTree::start(Way<Squares>& way) const {
  way.depth = 0, way.block = no_id, way.levels[0].left = 0, way.in_block.content = nullptr;
  if (root_ == no_id) return;
  if ((root_ & block_bit) != 0)
    way.block = root_;
  else
    way.levels[0].start(way.squares_of, nodes_[root_], nodes_[root_].child, infinity);
}

/// Goes on to the nearest block within a limit. Returns false if there is none.
template <class Squares>
bool QueryTree::next_block(Way<Squares>& way, double limit) const {
  for (std::size_t lane = 0;;) {
    if (!way.levels[way.depth].take(limit, lane)) {
      if (way.depth == 0) return false;
      --way.depth;
      continue;
    }
    const std::uint32_t child = way.levels[way.depth].content[lane];
    if ((child & block_bit) != 0) {
      way.block = child;
      return true;
    }
    way.levels[++way.depth].start(way.squares_of, nodes_[child], nodes_[child].child, limit);
  }
}

template <class Squares, class Visitor>
void QueryTree::visit_by(Way<Squares>& way, double margin, Visitor& visitor) const {
  const auto limit = [&] {
    const double reach = visitor.reach() + margin;
    return reach * reach;
  };
  while (way.block != no_id || next_block(way, limit())) {
    const Block& block = blocks_[way.block & ~block_bit];
    Level<Squares>& in = way.in_block;
    if (in.content != block.item) in.start(way.squares_of, block, block.item, limit());
    for (std::size_t lane = 0; in.take(limit(), lane);)
      if (!visitor.visit(block.item[lane], std::max(std::sqrt(double(in.squares[lane])) - margin, 0.0))) return;
    way.block = no_id;
  }
}

template <class Visitor>
void QueryTree::visit_near(Path& path, Visitor& visitor) const {
  if (path.far_ <= max_float_distance) return visit_by(path.way_, 2e-6 * (1 + path.far_), visitor);
  Way<DoubleSquares> way;
  way.squares_of = {item_boxes_.data(), path.point_};
  start(way);
  visit_by(way, 0x1p-50 * path.far_, visitor);
}

}}  // namespace tessera::abi_0_1
