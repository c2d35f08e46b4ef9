#include "exact/transposed.h"

#include <utility>

namespace tessera { inline namespace abi_0_1 {
namespace {

Result<BSplineSurface> transposed(const BSplineSurface& s) {
  std::vector<Vec3> points;
  std::vector<double> weights;
  points.reserve(s.points().size());
  weights.reserve(s.weights().size());
  for (std::size_t j = 0; j < s.count_v(); ++j)
    for (std::size_t i = 0; i < s.count_u(); ++i) {
      points.push_back(s.point(i, j));
      if (s.is_rational()) weights.push_back(s.weight(i, j));
    }
  const Domain turned{s.domain().v0, s.domain().v1, s.domain().u0, s.domain().u1};
  return s.is_rational() ? BSplineSurface::rational(s.degree_v(), s.knots_v(), s.degree_u(), s.knots_u(),
                                                    std::move(points), std::move(weights), turned)
                         : BSplineSurface::polynomial(s.degree_v(), s.knots_v(), s.degree_u(), s.knots_u(),
                                                      std::move(points), turned);
}

Result<Curve> transposed(const Curve& curve) {
  std::vector<Vec3> points(curve.points().begin(), curve.points().end());
  for (Vec3& p : points) std::swap(p.x, p.y);
  return curve.is_rational() ? Curve::nurbs(curve.degree(), points, curve.weights(), curve.knots(), curve.domain())
                             : Curve::b_spline(curve.degree(), points, curve.knots(), curve.domain());
}

}  // namespace

Status turn_around(BSplineSurface& surface, std::vector<TrimLoop>& loops) {
  Result<BSplineSurface> swapped = transposed(surface);
  if (!swapped) return swapped.status();
  surface = *std::move(swapped);
  for (TrimLoop& loop : loops)
    for (Curve& curve : loop.curves) {
      Result<Curve> turned = transposed(curve);
      if (!turned) return turned.status();
      curve = *std::move(turned);
    }
  return {};
}

}}  // namespace tessera::abi_0_1
