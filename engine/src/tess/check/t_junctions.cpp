#include "tess/check/t_junctions.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/point_tree.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

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
  std::vector<Vec3> points;
  for (const std::uint32_t end : ends) points.push_back(vertices[end]);
  const PointTree tree(std::move(points));
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
    tree.visit_box(box, [&, first = first, second = second](std::uint32_t end) {
      const std::uint32_t k = ends[end];
      if (k != first && k != second && lies_inside(vertices[k], a, b, reach)) found.push_back(k);
    });
  }
  std::sort(found.begin(), found.end());
  return static_cast<std::size_t>(std::unique(found.begin(), found.end()) - found.begin());
}

}}  // namespace tessera::abi_0_1
