#include "tess/trimmed/speed_bound.h"

#include <algorithm>
#include <cmath>

#include "surface/net/homogeneous.h"

namespace tessera::inline abi_0_1 {
namespace {

constexpr double rounded = 1 + 0x1p-40;  // far above the rounding of these sums

/// The largest difference of neighbours in a net, along one parameter: of vectors and of weights.
struct Steps {
  double vector = 0, weight = 0;
  void add(const Homogeneous& a, const Homogeneous& b) {
    vector = std::max(vector, length(b.vector() - a.vector()));
    weight = std::max(weight, std::abs(b.w - a.w));
  }
};

}  // namespace

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
    return rounded * net.scale * degree * std::min(by_hull, by_size);
  };
  return {bound(m, along_u), bound(n, along_v)};
}

}  // namespace tessera::inline abi_0_1
