#include "model/box_tree.h"

#include <algorithm>

namespace tessera { inline namespace abi_0_1 {
namespace {

double along(const Vec3& p, int axis) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }

int longest_axis(const Box3& box) {
  const Vec3 size = box.upper - box.lower;
  return size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
}

}  // namespace

bool are_near(const Box3& a, const Box3& b, double reach) {
  return !a.empty() && !b.empty() && meet(grown(a, reach), b);
}

BoxTree::BoxTree(std::span<const Box3> boxes) {
  std::vector<std::uint32_t> order;
  for (std::uint32_t k = 0; k < boxes.size(); ++k)
    if (!boxes[k].empty()) order.push_back(k);
  nodes_.reserve(2 * order.size() + 1);
  if (order.empty())
    nodes_.push_back({{}, 1});
  else
    add(boxes, order);
}

void BoxTree::add(std::span<const Box3> boxes, std::span<std::uint32_t> order) {
  const std::size_t own = nodes_.size();
  Node node;
  Box3 centres;
  for (const std::uint32_t k : order) node.box.extend(boxes[k]), centres.extend(boxes[k].centre());
  nodes_.push_back(node);
  if (order.size() > 1) {
    const int axis = longest_axis(centres);
    const auto middle = order.begin() + static_cast<std::ptrdiff_t>(order.size() / 2);
    std::nth_element(order.begin(), middle, order.end(), [&](std::uint32_t a, std::uint32_t b) {
      return along(boxes[a].centre(), axis) < along(boxes[b].centre(), axis);
    });
    add(boxes, {order.begin(), middle});
    add(boxes, {middle, order.end()});
  }
  nodes_[own].skip = nodes_.size();
}

bool BoxTree::touches(const Box3& box, double reach) const {
  if (box.empty()) return false;
  const Box3 wanted = grown(box, reach);
  for (std::size_t k = 0; k < nodes_.size();) {
    if (!meet(nodes_[k].box, wanted)) {
      k = nodes_[k].skip;
      continue;
    }
    if (nodes_[k].skip == k + 1) return true;
    ++k;
  }
  return false;
}

BoxTree tree_towards(std::span<const Box3> others, std::span<const Box3> boxes, double reach) {
  // Where the others lie at both ends of a strip, their box holds all of it. A tree of the others tells the ends apart.
  if (boxes.size() <= others.size()) return BoxTree(boxes);
  const BoxTree border(others);
  std::vector<Box3> near;
  for (const Box3& box : boxes)
    if (border.touches(box, 2 * reach)) near.push_back(box);  // twice, as rounding differs with the box that grows
  return BoxTree(near);
}

}}  // namespace tessera::abi_0_1
