#include "tess/trimmed/speed_bound.h"

#include <algorithm>
#include <cmath>

#include "surface/net/homogeneous.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr double rounding_factor = 1 + 0x1p-40;  // far above the rounding of these sums

/// The largest difference of neighbours in a net, along one parameter: of vectors and of weights.
struct Steps {
  double vector = 0, weight = 0;
  void add(const Homogeneous& a, const Homogeneous& b) {
    vector = std::max(vector, length(b.vector() - a.vector()));
    weight = std::max(weight, std::abs(b.w - a.w));
  }
};

/// Bounds |r_u . r_v| of a polynomial patch by the products of all steps, which are far fewer than 2^10.
double largest_product(const HomogeneousNet& net) {
  const int m = net.degree_u, n = net.degree_v;
  double most = 0;
  for (int i = 0; i < m; ++i)
    for (int j = 0; j <= n; ++j) {
      const Vec3 along_u = (net.at(i + 1, j) - net.at(i, j)).vector();
      for (int k = 0; k <= m; ++k)
        for (int l = 0; l < n; ++l)
          most = std::max(most, std::abs(dot(along_u, (net.at(k, l + 1) - net.at(k, l)).vector())));
    }
  return net.scale * net.scale * m * n * most;
}

}  // namespace

double SpeedBound::moved(double du, double dv) const {
  return std::sqrt(u * du * (u * du) + 2 * product * (du * dv) + v * dv * (v * dv));
}

SpeedBound SpeedBound::of(const BezierPatch& patch) {
  const Vec3 centre = patch.hull_box().centre();
  const HomogeneousNet net(patch, centre);
  const int m = net.degree_u, n = net.degree_v;
  Steps along_u, along_v;
  double reach = 0, lightest = net.at(0, 0).w, heaviest = lightest;
  for (int i = 0; i <= m; ++i) {
    for (int j = 0; j <= n; ++j) {
      const Homogeneous& point = net.at(i, j);
      if (i < m) along_u.add(point, net.at(i + 1, j));
      if (j < n) along_v.add(point, net.at(i, j + 1));
      reach = std::max(reach, length(point.vector()) / point.w);
      lightest = std::min(lightest, point.w);
      heaviest = std::max(heaviest, point.w);
    }
  }
  const auto bound = [&](int degree, const Steps& steps) {
    const double by_hull = (steps.vector + steps.weight * reach) / lightest;
    const double by_size = patch.is_rational() ? heaviest / lightest * 2 * reach : by_hull;
    return rounding_factor * net.scale * degree * std::min(by_hull, by_size);
  };
  SpeedBound speed{bound(m, along_u), bound(n, along_v), 0};
  speed.product = speed.u * speed.v;
  constexpr int most_steps = 12;  // of a bicubic patch
  if (!patch.is_rational() && m * (n + 1) <= most_steps && n * (m + 1) <= most_steps)
    speed.product = std::min(speed.product, rounding_factor * largest_product(net) + 0x1p-40 * speed.product);
  return speed;
}

}}  // namespace tessera::abi_0_1
