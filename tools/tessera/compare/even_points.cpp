#include "compare/even_points.h"

#include <algorithm>
#include <cmath>

#include "render/mesh_distance.h"

namespace tessera::cli {
namespace {

Vec3 corner_of(const Mesh& mesh, std::size_t triangle, std::size_t corner) {
  return render::position_of(mesh, mesh.indices[3 * triangle + corner]);
}

}  // namespace

Result<EvenPoints> EvenPoints::make(const Mesh& mesh) {
  EvenPoints made;
  made.sums_.reserve(mesh.triangle_count());
  double sum = 0;
  for (std::size_t k = 0; k < mesh.triangle_count(); ++k) {
    const Vec3 a = corner_of(mesh, k, 0), b = corner_of(mesh, k, 1), c = corner_of(mesh, k, 2);
    sum += 0.5 * length(cross(b - a, c - a));
    made.sums_.push_back(sum);
  }
  if (!std::isfinite(sum)) return Status(StatusCode::invalid_argument, "the areas of the mesh's triangles overflow");
  if (!(sum > 0)) return Status(StatusCode::invalid_argument, "the mesh has no triangle with an area");
  return made;
}

TrianglePoint EvenPoints::point(std::size_t k, std::size_t count) const {
  constexpr double first = 0.7548776662466927, second = 0.5698402909980532;  // 1/r and 1/r^2 of r^3 = r + 1
  const double area = (static_cast<double>(k) + 0.5) / static_cast<double>(count) * sums_.back();
  const auto at = std::upper_bound(sums_.begin(), sums_.end() - 1, area);
  double whole = 0;
  double b = std::modf(0.5 + static_cast<double>(k) * first, &whole);
  double c = std::modf(0.5 + static_cast<double>(k) * second, &whole);
  if (b + c > 1) b = 1 - b, c = 1 - c;
  return {static_cast<std::size_t>(at - sums_.begin()), b, c};
}

Vec3 place_of(const Mesh& mesh, const TrianglePoint& point) {
  const Vec3 a = corner_of(mesh, point.triangle, 0), b = corner_of(mesh, point.triangle, 1),
             c = corner_of(mesh, point.triangle, 2);
  return a + point.b * (b - a) + point.c * (c - a);
}

}  // namespace tessera::cli
