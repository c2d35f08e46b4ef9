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

/// Puts the boxes of an item into its place.
void QueryTree::set_item(std::size_t place, const ItemBoxes& boxes, std::uint32_t item) {
  constexpr double margin = 4e-7;  // for the centre and the axes over the scene's size, in float
  Block& block = blocks_[place / width];
  const std::size_t lane = place % width;
  block.item[lane] = item;
  const PieceBox& box = boxes.box;
  for (int c = 0; c < 3; ++c) {
    block.boxes.centre[c][lane] = static_cast<float>(component(box.centre, c));
    for (int a = 0; a < 3; ++a) block.boxes.axes[a][c][lane] = static_cast<float>(component(box.axes[a], c));
    block.boxes.half[c][lane] = rounded_up(box.half[c] + margin);
  }
  const Vec3 &lower = boxes.axis_box.lower, &upper = boxes.axis_box.upper;
  item_boxes_[item] = {rounded_down(lower.x), rounded_down(lower.y), rounded_down(lower.z),
                       rounded_up(upper.x),   rounded_up(upper.y),   rounded_up(upper.z)};
  place_of_[item] = static_cast<std::uint32_t>(place);
}

void QueryTree::set_child(Node& node, std::size_t lane, const Box3& box) {
  for (int c = 0; c < 3; ++c) {
    node.boxes.lower[c][lane] = rounded_down(component(box.lower, c));
    node.boxes.upper[c][lane] = rounded_up(component(box.upper, c));
  }
}

/// Returns the box of a node or a block by what it holds.
Box3 QueryTree::box_of(std::uint32_t child) const {
  Box3 box;
  if ((child & block_bit) != 0) {
    for (const std::uint32_t item : blocks_[child & ~block_bit].item) {
      if (item == no_id) break;
      const auto& of = item_boxes_[item];
      box.extend(Vec3{of[0], of[1], of[2]});
      box.extend(Vec3{of[3], of[4], of[5]});
    }
    return box;
  }
  const Node& node = nodes_[child];
  for (std::size_t k = 0; k < width; ++k) {
    if (node.child[k] == no_id) continue;
    box.extend(Vec3{node.boxes.lower[0][k], node.boxes.lower[1][k], node.boxes.lower[2][k]});
    box.extend(Vec3{node.boxes.upper[0][k], node.boxes.upper[1][k], node.boxes.upper[2][k]});
  }
  return box;
}

std::uint32_t QueryTree::make_block(std::span<const ItemBoxes> items, std::span<const std::uint32_t> order) {
  const std::size_t place = blocks_.size() * width;
  Block& block = blocks_.emplace_back();
  std::ranges::fill(block.item, no_id);
  for (float(&half)[width] : block.boxes.half) std::ranges::fill(half, -float_infinity);
  for (std::size_t k = 0; k < order.size(); ++k) set_item(place + k, items[order[k]], order[k]);
  return static_cast<std::uint32_t>(place / width) | block_bit;
}

/// Cuts a run of items in two, again and again, until there are eight parts of whole blocks. Each cut is across the
/// longest side of the box of middles, at the median.
std::uint32_t QueryTree::build_part(std::span<const ItemBoxes> items, std::span<std::uint32_t> order) {
  if (order.size() <= width) return make_block(items, order);
  std::array<std::span<std::uint32_t>, width> parts{order};
  std::size_t count = 1;
  const auto middle = [&](std::uint32_t k, int axis) {
    return component(items[k].axis_box.lower, axis) + component(items[k].axis_box.upper, axis);
  };
  while (count < width) {
    std::size_t largest = 0;
    for (std::size_t k = 1; k < count; ++k)
      if (parts[k].size() > parts[largest].size()) largest = k;
    const std::span<std::uint32_t> part = parts[largest];
    if (part.size() <= width) break;
    Box3 box;
    for (const std::uint32_t k : part) box.extend(Vec3{middle(k, 0), middle(k, 1), middle(k, 2)});
    const Vec3 size = box.upper - box.lower;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::size_t half = (part.size() / 2 + width - 1) / width * width;
    std::nth_element(part.begin(), part.begin() + static_cast<std::ptrdiff_t>(half), part.end(),
                     [&](std::uint32_t a, std::uint32_t b) {
                       const double x = middle(a, axis), y = middle(b, axis);
                       return x < y || (x == y && a < b);
                     });
    for (std::size_t k = count; k > largest + 1; --k) parts[k] = parts[k - 1];
    parts[largest] = part.first(half), parts[largest + 1] = part.subspan(half);
    ++count;
  }
  const std::size_t place = nodes_.size();
  nodes_.emplace_back();
  for (std::size_t k = 0; k < width; ++k) {
    const std::uint32_t child = k < count ? build_part(items, parts[k]) : no_id;
    nodes_[place].child[k] = child;
    set_child(nodes_[place], k, k < count ? box_of(child) : Box3{});
  }
  return static_cast<std::uint32_t>(place);
}

void QueryTree::build(std::span<const ItemBoxes> items) {
  nodes_.clear(), blocks_.clear();
  item_boxes_.resize(items.size()), place_of_.resize(items.size());
  blocks_.reserve(items.size() / width + 1);
  std::vector<std::uint32_t> order(items.size());
  std::iota(order.begin(), order.end(), 0u);
  root_ = items.empty() ? no_id : build_part(items, order);
}

void QueryTree::refit(std::span<const Change> changes) {
  for (const Change& change : changes) set_item(place_of_[change.item], change.boxes, change.item);
  for (std::size_t k = nodes_.size(); k-- > 0;) {
    for (std::size_t lane = 0; lane < width; ++lane) {
      Node& node = nodes_[k];
      if (node.child[lane] != no_id) set_child(node, lane, box_of(node.child[lane]));
    }
  }
}

void QueryTree::begin(const kernel::NearestKernels& kernels, const Vec3& point, Path& path) const {
  path.point_ = point, path.far_ = max_abs(point);
  if (!(path.far_ <= max_float_distance)) return;
  Way<FloatSquares>& way = path.way_;
  const auto narrow = [](double x) { return static_cast<float>(x); };
  way.squares_of = {&kernels, {narrow(point.x), narrow(point.y), narrow(point.z)}};
  start(way);
  if (way.block != no_id || next_block(way, infinity)) fetch(&blocks_[way.block & ~block_bit], sizeof(Block));
}

std::uint32_t QueryTree::nearest_item(Path& path) const {
  Way<FloatSquares>& way = path.way_;
  if (!(path.far_ <= max_float_distance) || way.block == no_id) return no_id;
  const Block& block = blocks_[way.block & ~block_bit];
  way.in_block.start(way.squares_of, block, block.item, infinity);
  return way.in_block.left != 0 ? block.item[way.in_block.nearest()] : no_id;
}

std::size_t QueryTree::memory_bytes() const {
  return nodes_.capacity() * sizeof(Node) + blocks_.capacity() * sizeof(Block) +
         place_of_.capacity() * sizeof(std::uint32_t) + item_boxes_.capacity() * sizeof(item_boxes_[0]);
}

}}  // namespace tessera::abi_0_1
