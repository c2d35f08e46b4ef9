#include "ray/polished_root.h"

#include <algorithm>
#include <cmath>

#include "ray/leaf_search.h"
#include "ray/projected_net.h"

namespace tessera {
namespace {

constexpr int most_steps = 6;
constexpr double linear = 1e-9;  // steps up to that leave a square of it

/// A net's homogeneous point and derivatives.
struct NetPosition {
  Vec3 point, du, dv;
  double w = 1, wu = 0, wv = 0;
};

template <bool Rational, int M, int N>
NetPosition position(const NetShape<M, N>& shape, const double* net, double u, double v) {
  const NetBasis<M> bu(shape.m(), u);
  const NetBasis<N> bv(shape.n(), v);
  const int size = shape.size();
  NetPosition out;
  if constexpr (Rational) out.w = 0;
  int k = 0;
  for (int i = 0; i <= shape.m(); ++i) {
    double x = 0, y = 0, z = 0, w = 0, xv = 0, yv = 0, zv = 0, wv = 0;
    for (int j = 0; j <= shape.n(); ++j, ++k) {
      const double b = bv.value[static_cast<std::size_t>(j)], d = bv.derivative[static_cast<std::size_t>(j)];
      x += b * net[k], y += b * net[size + k], z += b * net[2 * size + k];
      xv += d * net[k], yv += d * net[size + k], zv += d * net[2 * size + k];
      if constexpr (Rational) w += b * net[3 * size + k], wv += d * net[3 * size + k];
    }
    const double b = bu.value[static_cast<std::size_t>(i)], d = bu.derivative[static_cast<std::size_t>(i)];
    out.point += Vec3{b * x, b * y, b * z};
    out.du += Vec3{d * x, d * y, d * z};
    out.dv += Vec3{b * xv, b * yv, b * zv};
    if constexpr (Rational) out.w += b * w, out.wu += d * w, out.wv += b * wv;
  }
  return out;
}

/// The net's value as the ray sees it.
NetValue seen(const NetPosition& at, const RayLine& line) {
  const Vec3 from = at.point - at.w * line.start;
  const Vec3 du = at.du - at.wu * line.start, dv = at.dv - at.wv * line.start;
  NetValue f;
  f.x = dot(line.across[0], from), f.y = dot(line.across[1], from), f.z = dot(line.direction, from), f.w = at.w;
  f.xu = dot(line.across[0], du), f.xv = dot(line.across[0], dv);
  f.yu = dot(line.across[1], du), f.yv = dot(line.across[1], dv);
  return f;
}

template <bool Rational, int M, int N>
bool polish(const Leaf& leaf, const double* net, const RayLine& line, const kernel::RayRoot& proven, LeafRoot& root) {
  const NetShape<M, N> shape{leaf.degree_u, leaf.degree_v};
  const double start_u = 0.5 + static_cast<double>(proven.u), start_v = 0.5 + static_cast<double>(proven.v);
  const double reach_u = 2 * static_cast<double>(proven.radius_u), reach_v = 2 * static_cast<double>(proven.radius_v);
  double u = start_u, v = start_v;
  for (int step = 0; step < most_steps; ++step) {
    const NetPosition at = position<Rational>(shape, net, u, v);
    const NetValue f = seen(at, line);
    const double inverse = 1 / (f.xu * f.yv - f.xv * f.yu);
    const double du = -(f.x * f.yv - f.y * f.xv) * inverse, dv = -(f.y * f.xu - f.x * f.yu) * inverse;
    u += du, v += dv;
    // Twice as far as it can be. Written so that NaN fails.
    if (!(std::abs(u - start_u) <= reach_u && std::abs(v - start_v) <= reach_v && u >= 0 && u <= 1 && v >= 0 && v <= 1))
      return false;
    if (std::max(std::abs(du), std::abs(dv)) > linear) continue;
    root.patch = leaf.patch;
    root.u = leaf.u0 + u * leaf.du, root.v = leaf.v0 + v * leaf.dv;
    const double s = f.s(), weight = 1 / f.w;
    root.s = s + weight * (du * (dot(line.direction, at.du - at.wu * line.start) - s * at.wu) +
                           dv * (dot(line.direction, at.dv - at.wv * line.start) - s * at.wv));
    const double rounding = search_rounding(shape.m(), shape.n(), leaf.halvings, 0);
    root.residual = rounding;
    root.certified = true;
    return set_radius(f, rounding, leaf.du, leaf.dv, root);
  }
  return false;
}

}  // namespace

bool polish(const Leaf& leaf, const double* net, const RayLine& line, const kernel::RayRoot& proven, LeafRoot& root) {
  const bool cubic = leaf.degree_u == 3 && leaf.degree_v == 3, quadratic = leaf.degree_u == 2 && leaf.degree_v == 2;
  if (leaf.rational)
    return quadratic ? polish<true, 2, 2>(leaf, net, line, proven, root)
                     : polish<true, 0, 0>(leaf, net, line, proven, root);
  return cubic ? polish<false, 3, 3>(leaf, net, line, proven, root)
               : polish<false, 0, 0>(leaf, net, line, proven, root);
}

}  // namespace tessera
