#include "tess/check/t_junctions.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace tessera { inline namespace abi_0_1 {
namespace {

double component(const Vec3& p, int axis) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }

/// A k-d tree of points without nodes: the middle element of each range divides the others along the axis of its depth
/// (Bentley 1975, Multidimensional binary search trees).
class PointTree {
 public:
  PointTree(std::span<const Vec3> points, std::vector<std::uint32_t> order)
      : points_(points), order_(std::move(order)) {
    divide(0, order_.size(), 0);
  }

  /// Calls visit(k) for the points in a box.
  template <class Visit>
  void in_box(const Box3& box, const Visit& visit) const {
    in_box(box, visit, 0, order_.size(), 0);
  }

 private:
  void divide(std::size_t begin, std::size_t end, int axis) {
    if (end - begin < 2) return;
    const std::size_t middle = begin + (end - begin) / 2;
    const auto at = [&](std::size_t k) { return order_.begin() + static_cast<std::ptrdiff_t>(k); };
    std::nth_element(at(begin), at(middle), at(end), [&](std::uint32_t a, std::uint32_t b) {
      return component(points_[a], axis) < component(points_[b], axis);
    });
    divide(begin, middle, (axis + 1) % 3);
    divide(middle + 1, end, (axis + 1) % 3);
  }

  template <class Visit>
  void in_box(const Box3& box, const Visit& visit, std::size_t begin, std::size_t end, int axis) const {
    if (begin == end) return;
    const std::size_t middle = begin + (end - begin) / 2;
    const Vec3& p = points_[order_[middle]];
    const double x = component(p, axis);
    if (component(box.lower, axis) <= x) in_box(box, visit, begin, middle, (axis + 1) % 3);
    if (p.x >= box.lower.x && p.x <= box.upper.x && p.y >= box.lower.y && p.y <= box.upper.y && p.z >= box.lower.z &&
        p.z <= box.upper.z)
      visit(order_[middle]);
    if (component(box.upper, axis) >= x) in_box(box, visit, middle + 1, end, (axis + 1) % 3);
  }

  std::span<const Vec3> points_;
  std::vector<std::uint32_t> order_;
};

bool lies_inside(const Vec3& p, const Vec3& a, const Vec3& b, double reach) {
  const Vec3 edge = b - a;
  const double t = dot(p - a, edge) / dot(edge, edge);
  return t >= 1e-3 && t <= 1 - 1e-3 && length(p - (a + t * edge)) <= reach;
}

}  // namespace

std::size_t count_t_junctions(std::span<const Vec3> vertices, std::span<const std::array<std::uint32_t, 2>> edges,
                              double rounding) {
  std::vector<std::uint32_t> ends;
  for (const auto& edge : edges)
    for (const std::uint32_t end : edge)
      if (is_finite(vertices[end])) ends.push_back(end);
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  const PointTree tree(vertices, ends);
  std::vector<std::uint32_t> found;
  for (const auto& [first, second] : edges) {
    const Vec3 &a = vertices[first], &b = vertices[second];
    if (!is_finite(a) || !is_finite(b)) continue;
    const double reach = 1e-6 * length(b - a) + rounding * std::max(max_abs(a), max_abs(b));
    Box3 box;
    box.extend(a);
    box.extend(b);
    const Vec3 margin{reach, reach, reach};
    box = {box.lower - margin, box.upper + margin};
    tree.in_box(box, [&, first = first, second = second](std::uint32_t k) {
      if (k != first && k != second && lies_inside(vertices[k], a, b, reach)) found.push_back(k);
    });
  }
  std::sort(found.begin(), found.end());
  return static_cast<std::size_t>(std::unique(found.begin(), found.end()) - found.begin());
}

}}  // namespace tessera::abi_0_1
