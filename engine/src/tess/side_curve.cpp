#include "tess/side_curve.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace tessera {

SideCurve::SideCurve(const BezierPatch& patch, Side side) {
  const bool along_u = runs_along_u(side);
  degree_ = along_u ? patch.degree_u() : patch.degree_v();
  const int across = along_u ? (side == Side::v1 ? patch.degree_v() : 0) : (side == Side::u1 ? patch.degree_u() : 0);
  const auto index = [&](int k) { return along_u ? std::array{k, across} : std::array{across, k}; };
  const auto weight_at = [&](int k) { return patch.weight(index(k)[0], index(k)[1]); };
  const double ends = 0.5 * weight_at(0) + 0.5 * weight_at(degree_);
  for (int k = 0; k <= degree_; ++k) {
    points_[static_cast<std::size_t>(k)] = patch.point(index(k)[0], index(k)[1]);
    weights_[static_cast<std::size_t>(k)] = weight_at(k) / ends;
  }
}

Box3 SideCurve::box() const {
  Box3 box;
  for (int k = 0; k <= degree_; ++k) box.extend(point(k));
  return box;
}

void SideCurve::elevate(int degree) {
  // Farin, Curves and Surfaces for CAGD, 5th ed., sec. 6.1, in ratios so that points stay what they are where they agree.
  for (; degree_ < degree; ++degree_) {
    const auto n = static_cast<std::size_t>(degree_);
    points_[n + 1] = points_[n];
    weights_[n + 1] = weights_[n];
    for (std::size_t k = n; k > 0; --k) {
      const double share = static_cast<double>(k) / static_cast<double>(n + 1);
      const double before = share * weights_[k - 1], after = (1 - share) * weights_[k];
      points_[k] = points_[k] + before / (before + after) * (points_[k - 1] - points_[k]);
      weights_[k] = before + after;
    }
  }
}

double distance_bound(SideCurve a, SideCurve b, bool reversed) {
  a.elevate(b.degree());
  b.elevate(a.degree());
  double apart = 0, weights = 0;
  for (int k = 0; k <= a.degree(); ++k) {
    const int other = reversed ? b.degree() - k : k;
    apart = std::max(apart, length(a.point(k) - b.point(other)));
    weights = std::max(weights, std::abs(a.weight(k) - b.weight(other)) / a.weight(k));
  }
  const double bound = apart + (weights > 0 ? weights * b.box().diagonal() : 0);
  return std::isnan(bound) ? std::numeric_limits<double>::infinity() : bound;
}

Result<BezierPatch> with_pole(const BezierPatch& patch, Side side) {
  std::vector<Vec3> points(patch.points().begin(), patch.points().end());
  const int m = patch.degree_u(), n = patch.degree_v();
  const auto at = [&](int i, int j) -> Vec3& { return points[static_cast<std::size_t>(i * (n + 1) + j)]; };
  if (runs_along_u(side)) {
    for (int i = 0, j = side == Side::v1 ? n : 0; i <= m; ++i) at(i, j) = at(0, j);
  } else {
    for (int j = 0, i = side == Side::u1 ? m : 0; j <= n; ++j) at(i, j) = at(i, 0);
  }
  return patch.with_points(points);
}

}  // namespace tessera
