#include <algorithm>
#include <string>

#include "convert/basis/bezier_net.h"
#include "tessera/guard.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Checks what a net needs before it is laid out; BezierPatch checks the rest.
Status check_curve(const BezierPolygon& curve) {
  const std::size_t size = curve.points.size();
  if (size < 2 || size > max_degree + 1)
    return {StatusCode::unsupported_degree,
            "a curve has 2 to " + std::to_string(max_degree + 1) + " points, found " + std::to_string(size)};
  if (!curve.weights.empty() && curve.weights.size() != size)
    return {StatusCode::count_mismatch, "a curve of " + std::to_string(size) + " points has " + std::to_string(size) +
                                            " weights or none, found " + std::to_string(curve.weights.size())};
  return {};
}

/// Returns the patch whose rows are two curves with the weights of the first; polynomial if these are all equal.
Result<BezierPatch> patch_of_rows(const BezierPolygon& c0, std::span<const Vec3> c1) {
  const int degree = static_cast<int>(c0.points.size()) - 1;
  std::vector<Vec3> points = c0.points;
  points.insert(points.end(), c1.begin(), c1.end());
  if (c0.weights.empty()) return BezierPatch::polynomial(1, degree, points);
  std::vector<double> weights = c0.weights;
  weights.insert(weights.end(), c0.weights.begin(), c0.weights.end());
  return BezierPatch::rational(1, degree, points, weights);
}

}  // namespace

Result<BezierPatch> make_ruled(const BezierPolygon& c0, const BezierPolygon& c1) {
  return guarded([&]() -> Result<BezierPatch> {
    for (const BezierPolygon* curve : {&c0, &c1}) {
      if (Status status = check_curve(*curve); !status.ok()) return status;
      if (auto flat = patch_of_rows(*curve, curve->points); !flat) return flat;  // before it is elevated
    }
    const int degree = static_cast<int>(std::max(c0.points.size(), c1.points.size())) - 1;
    const BezierPolygon row0 = elevated(c0, degree), row1 = elevated(c1, degree);
    if (row0.weights != row1.weights)
      return Status(StatusCode::unsupported,
                    "the two curves have different weights: the ruled surface between them is of a higher degree");
    return patch_of_rows(row0, row1.points);
  });
}

Result<BezierPatch> make_cylinder(const BezierPolygon& curve, const Vec3& direction) {
  return guarded([&]() -> Result<BezierPatch> {
    if (Status status = check_curve(curve); !status.ok()) return status;
    if (direction == Vec3{})
      return Status(StatusCode::invalid_argument, "the direction of the cylinder is zero, it must not be");
    std::vector<Vec3> moved;
    for (const Vec3& p : curve.points) moved.push_back(p + direction);
    return patch_of_rows(curve, moved);
  });
}

Result<BezierPatch> make_cone(const Vec3& apex, const BezierPolygon& curve) {
  return guarded([&]() -> Result<BezierPatch> {
    if (Status status = check_curve(curve); !status.ok()) return status;
    BezierPolygon pole{std::vector<Vec3>(curve.points.size(), apex), curve.weights};
    return patch_of_rows(pole, curve.points);
  });
}

Result<BezierPatch> make_hyperbolic_paraboloid(const Vec3& r00, const Vec3& r01, const Vec3& r10, const Vec3& r11) {
  return BezierPatch::polynomial(1, 1, std::array{r00, r01, r10, r11});
}

}}  // namespace tessera::abi_0_1
