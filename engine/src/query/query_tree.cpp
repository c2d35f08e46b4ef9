#include "query/query_tree.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr float float_infinity = std::numeric_limits<float>::infinity();

float rounded_down(double x) { return std::nextafter(static_cast<float>(x), -float_infinity); }
float rounded_up(double x) { return std::nextafter(static_cast<float>(x), float_infinity); }

double component(const Vec3& a, int axis) { return axis == 0 ? a.x : axis == 1 ? a.y : a.z; }

}  // namespace

void QueryTree::set_box(Block& block, std::size_t lane, const PieceBox& box) const {
  constexpr double margin = 4e-7;  // for the centre and the axes over the scene's size, in float
  for (int c = 0; c < 3; ++c) {
    block.centre[c][lane] = static_cast<float>(component(box.centre, c));
    for (int a = 0; a < 3; ++a) block.axes[a][c][lane] = static_cast<float>(component(box.axes[a], c));
    block.half[c][lane] = rounded_up(box.half[c] + margin);
  }
}

void QueryTree::set_child(Node& node, std::size_t lane, const Box3& box) {
  for (int c = 0; c < 3; ++c) {
    node.lower[c][lane] = rounded_down(component(box.lower, c));
    node.upper[c][lane] = rounded_up(component(box.upper, c));
  }
}

/// Returns the box of a node or a block by what it holds.
Box3 QueryTree::box_of(std::uint32_t child) const {
  Box3 box;
  if ((child & block_bit) != 0) {
    const Block& block = blocks_[child & ~block_bit];
    for (std::size_t k = block.first; k < block.first + block.count; ++k) {
      const auto& item = item_boxes_[k];
      box.extend(Vec3{item[0], item[1], item[2]});
      box.extend(Vec3{item[3], item[4], item[5]});
    }
    return box;
  }
  const Node& node = nodes_[child];
  for (std::size_t k = 0; k < width; ++k) {
    if (node.child[k] == no_id) continue;
    box.extend(Vec3{node.lower[0][k], node.lower[1][k], node.lower[2][k]});
    box.extend(Vec3{node.upper[0][k], node.upper[1][k], node.upper[2][k]});
  }
  return box;
}

std::uint32_t QueryTree::make_block(std::span<const ItemBoxes> items, std::size_t begin, std::size_t end) {
  Block block{};
  block.first = static_cast<std::uint32_t>(begin), block.count = static_cast<std::uint32_t>(end - begin);
  for (std::size_t k = begin; k < end; ++k) {
    const ItemBoxes& item = items[order_[k]];
    set_box(block, k - begin, item.box);
    const Box3& box = item.axis_box;
    item_boxes_[k] = {rounded_down(box.lower.x), rounded_down(box.lower.y), rounded_down(box.lower.z),
                      rounded_up(box.upper.x),   rounded_up(box.upper.y),   rounded_up(box.upper.z)};
  }
  blocks_.push_back(block);
  return static_cast<std::uint32_t>(blocks_.size() - 1) | block_bit;
}

/// Cuts a run of items in two, again and again, until there are eight parts of whole blocks. Each cut is across the
/// longest side of the box of middles, at the median.
std::uint32_t QueryTree::build_part(std::span<const ItemBoxes> items, std::size_t begin, std::size_t end) {
  if (end - begin <= width) return make_block(items, begin, end);
  std::array<std::size_t, width + 1> ends{begin, end};
  std::size_t parts = 1;
  const auto middle = [&](std::uint32_t k, int axis) {
    return component(items[k].axis_box.lower, axis) + component(items[k].axis_box.upper, axis);
  };
  while (parts < width) {
    std::size_t largest = 0;
    for (std::size_t k = 1; k < parts; ++k)
      if (ends[k + 1] - ends[k] > ends[largest + 1] - ends[largest]) largest = k;
    const std::size_t from = ends[largest], to = ends[largest + 1];
    if (to - from <= width) break;
    Box3 box;
    for (std::size_t k = from; k < to; ++k)
      box.extend(Vec3{middle(order_[k], 0), middle(order_[k], 1), middle(order_[k], 2)});
    const Vec3 size = box.upper - box.lower;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::size_t half = from + ((to - from) / 2 + width - 1) / width * width;
    const auto at = [&](std::size_t k) { return order_.begin() + static_cast<std::ptrdiff_t>(k); };
    std::nth_element(at(from), at(half), at(to), [&](std::uint32_t a, std::uint32_t b) {
      const double x = middle(a, axis), y = middle(b, axis);
      return x < y || (x == y && a < b);
    });
    for (std::size_t k = parts; k > largest; --k) ends[k + 1] = ends[k];
    ends[largest + 1] = half;
    ++parts;
  }
  const std::size_t place = nodes_.size();
  nodes_.emplace_back();
  for (std::size_t k = 0; k < width; ++k) {
    const std::uint32_t child = k < parts ? build_part(items, ends[k], ends[k + 1]) : no_id;
    nodes_[place].child[k] = child;
    set_child(nodes_[place], k, k < parts ? box_of(child) : Box3{});
  }
  return static_cast<std::uint32_t>(place);
}

void QueryTree::build(std::span<const ItemBoxes> items) {
  nodes_.clear(), blocks_.clear();
  order_.resize(items.size());
  std::iota(order_.begin(), order_.end(), 0u);
  item_boxes_.resize(items.size());
  blocks_.reserve(items.size() / width + 1);
  if (!items.empty()) root_ = build_part(items, 0, items.size());
  place_of_.resize(items.size());
  for (std::uint32_t k = 0; k < order_.size(); ++k) place_of_[order_[k]] = k;
}

void QueryTree::refit(std::span<const Change> changes) {
  for (const Change& change : changes) {
    const std::uint32_t place = place_of_[change.item];
    const Box3& box = change.boxes.axis_box;
    item_boxes_[place] = {rounded_down(box.lower.x), rounded_down(box.lower.y), rounded_down(box.lower.z),
                          rounded_up(box.upper.x),   rounded_up(box.upper.y),   rounded_up(box.upper.z)};
    const auto block = std::ranges::upper_bound(blocks_, place, {}, &Block::first) - 1;
    set_box(*block, place - block->first, change.boxes.box);
  }
  for (std::size_t k = nodes_.size(); k-- > 0;) {
    for (std::size_t lane = 0; lane < width; ++lane) {
      Node& node = nodes_[k];
      if (node.child[lane] != no_id) set_child(node, lane, box_of(node.child[lane]));
    }
  }
}

std::size_t QueryTree::memory_bytes() const {
  return nodes_.capacity() * sizeof(Node) + blocks_.capacity() * sizeof(Block) +
         (order_.capacity() + place_of_.capacity()) * sizeof(std::uint32_t) +
         item_boxes_.capacity() * sizeof(item_boxes_[0]);
}

}}  // namespace tessera::abi_0_1
