#include "peers/triangle_tree.h"

#include <algorithm>
#include <utility>

#include "support/triangle_distance.h"

namespace tessera::bench {
namespace {

constexpr std::uint32_t leaf_size = 4;

double coordinate(const Vec3& p, int axis) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }

double centre(const SurfaceTriangle& t, int axis) {
  return coordinate(t.corners[0], axis) + coordinate(t.corners[1], axis) + coordinate(t.corners[2], axis);
}

double distance_to_box(const Vec3& p, const Box3& box) {
  double squared = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double x = coordinate(p, axis);
    const double outside = std::max({coordinate(box.lower, axis) - x, 0.0, x - coordinate(box.upper, axis)});
    squared += outside * outside;
  }
  return std::sqrt(squared);
}

}  // namespace

TriangleTree::TriangleTree(std::vector<const SurfaceTriangle*> triangles) : triangles_(std::move(triangles)) {
  if (!triangles_.empty()) build(0, static_cast<std::uint32_t>(triangles_.size()));
}

void TriangleTree::build(std::uint32_t first, std::uint32_t last) {
  const std::size_t own = nodes_.size();
  Node node{{}, first, last, 0};
  for (std::uint32_t k = first; k < last; ++k)
    for (const Vec3& corner : triangles_[k]->corners) node.box.extend(corner);
  nodes_.push_back(node);
  if (last - first <= leaf_size) return;
  const Vec3 size = node.box.upper - node.box.lower;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const std::uint32_t middle = (first + last) / 2;
  const auto at = [&](std::uint32_t k) { return triangles_.begin() + static_cast<std::ptrdiff_t>(k); };
  std::nth_element(at(first), at(middle), at(last), [axis](const SurfaceTriangle* a, const SurfaceTriangle* b) {
    return centre(*a, axis) < centre(*b, axis);
  });
  build(first, middle);
  nodes_[own].right = static_cast<std::uint32_t>(nodes_.size());
  build(middle, last);
}

double TriangleTree::distance(const Vec3& p, double most) const {
  if (nodes_.empty()) return most;
  std::vector<std::pair<double, std::uint32_t>> open{{distance_to_box(p, nodes_[0].box), 0}};
  while (!open.empty()) {
    const auto [near, at] = open.back();
    open.pop_back();
    if (near >= most) continue;
    const Node& node = nodes_[at];
    if (node.right == 0) {
      for (std::uint32_t k = node.first; k < node.last; ++k) {
        const auto& c = triangles_[k]->corners;
        most = std::min(most, test::distance_to_triangle(p, c[0], c[1], c[2]));
      }
      continue;
    }
    std::pair<double, std::uint32_t> left{distance_to_box(p, nodes_[at + 1].box), at + 1},
        right{distance_to_box(p, nodes_[node.right].box), node.right};
    if (left.first > right.first) std::swap(left, right);
    open.push_back(right);
    open.push_back(left);
  }
  return most;
}

}  // namespace tessera::bench
