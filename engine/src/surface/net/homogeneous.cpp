#include "surface/net/homogeneous.h"

#include <algorithm>
#include <cmath>

namespace tessera { inline namespace abi_0_1 {

SurfaceJet project(const Homogeneous& a, const Homogeneous& au, const Homogeneous& av, const Homogeneous& auu,
                   const Homogeneous& auv, const Homogeneous& avv) {
  const double reciprocal = 1 / a.w;
  const Vec3 r = a.project();
  const Vec3 ru = reciprocal * (au.vector() - au.w * r), rv = reciprocal * (av.vector() - av.w * r);
  return {r,
          ru,
          rv,
          reciprocal * (auu.vector() - 2 * au.w * ru - auu.w * r),
          reciprocal * (auv.vector() - au.w * rv - av.w * ru - auv.w * r),
          reciprocal * (avv.vector() - 2 * av.w * rv - avv.w * r)};
}

double power_of_two_near(double x) {
  if (!(x > 0)) return 1;
  int exponent = 0;
  std::frexp(x, &exponent);
  return std::ldexp(1.0, std::clamp(exponent, -1000, 1000));
}

HomogeneousNet::HomogeneousNet(const BezierPatch& patch, const Vec3& origin)
    : degree_u(patch.degree_u()), degree_v(patch.degree_v()) {
  const auto from = patch.points();
  const auto weights = patch.weights();
  double largest = 0, largest_weight = 0;
  for (const Vec3& p : from) largest = std::max(largest, max_abs(p));
  for (const double weight : weights) largest_weight = std::max(largest_weight, weight);
  scale = power_of_two_near(largest);
  scaled_origin = (1 / scale) * origin;
  const double weight_factor = 1 / power_of_two_near(largest_weight);
  for (std::size_t k = 0; k < from.size(); ++k) {
    const double w = weights.empty() ? 1 : weight_factor * weights[k];
    const Vec3 p = w * ((1 / scale) * from[k] - scaled_origin);
    points[k] = {p.x, p.y, p.z, w};
  }
}

}}  // namespace tessera::abi_0_1
