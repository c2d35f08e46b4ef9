#pragma once
// Points in space, found by boxes.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "tessera/geometry.h"

namespace tessera { inline namespace abi_0_1 {

/// A balanced k-d tree of points (Bentley 1975), kept as a permutation of them: the middle of each range divides it.
class PointTree {
 public:
  explicit PointTree(std::vector<Vec3> points)
      : points_(std::move(points)), order_(points_.size()), axes_(points_.size()) {
    std::iota(order_.begin(), order_.end(), std::uint32_t{0});
    sort(0, order_.size());
  }

  /// Calls visit(index) for all points in a box, borders included.
  template <class Visit>
  void visit_box(const Box3& box, const Visit& visit) const {
    visit_box_while(box, [&](std::uint32_t index) {
      visit(index);
      return true;
    });
  }
  /// Calls visit(index) for points in a box, borders included, until it returns false.
  template <class Visit>
  void visit_box_while(const Box3& box, const Visit& visit) const {
    visit_range(box, visit, 0, order_.size());
  }

 private:
  static constexpr std::size_t leaf = 8;

  static double coordinate(const Vec3& p, int axis) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }

  void sort(std::size_t from, std::size_t to) {
    if (to - from <= leaf) return;
    Box3 box;
    for (std::size_t k = from; k < to; ++k) box.extend(points_[order_[k]]);
    const int axis = longest_axis(box);
    const std::size_t middle = from + (to - from) / 2;
    const auto at = [&](std::size_t k) { return order_.begin() + static_cast<std::ptrdiff_t>(k); };
    std::nth_element(at(from), at(middle), at(to), [&](std::uint32_t a, std::uint32_t b) {
      return coordinate(points_[a], axis) < coordinate(points_[b], axis);
    });
    axes_[middle] = static_cast<std::uint8_t>(axis);
    sort(from, middle);
    sort(middle + 1, to);
  }

  static int longest_axis(const Box3& box) {
    const Vec3 size = box.upper - box.lower;
    return size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  }

  static bool contains(const Box3& box, const Vec3& p) {
    return p.x >= box.lower.x && p.x <= box.upper.x && p.y >= box.lower.y && p.y <= box.upper.y && p.z >= box.lower.z &&
           p.z <= box.upper.z;
  }

  template <class Visit>
  bool visit_range(const Box3& box, const Visit& visit, std::size_t from, std::size_t to) const {
    if (to - from <= leaf) {
      for (std::size_t k = from; k < to; ++k)
        if (contains(box, points_[order_[k]]) && !visit(order_[k])) return false;
      return true;
    }
    const std::size_t middle = from + (to - from) / 2;
    const Vec3& p = points_[order_[middle]];
    const int axis = axes_[middle];
    if (contains(box, p) && !visit(order_[middle])) return false;
    if (coordinate(box.lower, axis) <= coordinate(p, axis) && !visit_range(box, visit, from, middle)) return false;
    return coordinate(box.upper, axis) < coordinate(p, axis) || visit_range(box, visit, middle + 1, to);
  }

  std::vector<Vec3> points_;
  std::vector<std::uint32_t> order_;
  std::vector<std::uint8_t> axes_;  ///< along which the point in the middle of a range divides it
};

}}  // namespace tessera::abi_0_1
