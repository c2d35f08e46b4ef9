#include "tess/edges/side_curve.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>
#include <vector>

namespace tessera { inline namespace abi_0_1 {

SideCurve::SideCurve(const BezierPatch& patch, Side side) {
  const bool along_u = runs_along_u(side);
  degree_ = along_u ? patch.degree_u() : patch.degree_v();
  const int across = !is_far(side) ? 0 : along_u ? patch.degree_v() : patch.degree_u();
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
  // Farin, Curves and Surfaces for CAGD, 5th ed., sec. 6.1. In ratios, so that points that are equal are unchanged.
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

namespace {

/// Compares curves of one degree point by point: -1, 0 or 1 if a is less, the same or greater.
int compare(const SideCurve& a, bool a_turned, const SideCurve& b, bool b_turned) {
  const int last = a.degree();
  for (int k = 0; k <= last; ++k) {
    const int i = a_turned ? last - k : k, j = b_turned ? last - k : k;
    const Vec3 p = a.point(i), q = b.point(j);
    const auto x = std::tuple(p.x, p.y, p.z, a.weight(i)), y = std::tuple(q.x, q.y, q.z, b.weight(j));
    if (x != y) return x < y ? -1 : 1;
  }
  return 0;
}

}  // namespace

bool comes_before(const SideCurve& a, const SideCurve& b) {
  if (a.degree() != b.degree()) return a.degree() < b.degree();
  return compare(a, compare(a, true, a, false) < 0, b, compare(b, true, b, false) < 0) < 0;
}

bool runs_against(const PatchSet::Impl& set, std::uint32_t border, std::uint32_t other) {
  if (border == other) return false;
  const Side side = all_sides[border % 4], other_side = all_sides[other % 4];
  const PackedBorder a(set, border / 4, side), b(set, other / 4, other_side);
  const bool same = equal(a, b, false), opposite = equal(a, b, true);
  assert(same || opposite);
  if (same != opposite) return opposite;
  const SideCurve p(set.patches[border / 4], side), q(set.patches[other / 4], other_side);
  return distance_bound(p, q, true) < distance_bound(p, q, false);
}

SharedEdges parted_by_doubles(const PatchSet::Impl& set, const SharedEdges& edges) {
  const auto curve = [&](std::uint32_t border) { return SideCurve(set.patches[border / 4], all_sides[border % 4]); };
  struct Place {
    std::uint32_t edge, border;
    double middle, reach;
    bool operator<(const Place& other) const {
      return std::tie(edge, middle, border) < std::tie(other.edge, other.middle, other.border);
    }
  };
  std::vector<std::uint32_t> numbers(4 * set.patches.size(), no_id);
  std::vector<Place> places;
  for (std::uint32_t border = 0; border < numbers.size(); ++border) {
    const std::uint32_t edge = edges.edge(border / 4, all_sides[border % 4]);
    if (edge == no_id) continue;
    const SideCurve along = curve(border);
    const double rounding = 0x1p-48 * std::max(max_abs(along.box().lower), max_abs(along.box().upper));
    places.push_back({edge, border,
                      dot(unaligned, 0.5 * (along.first() - set.origin) + 0.5 * (along.last() - set.origin)),
                      0x1p-20 * along.box().diagonal() + rounding});
  }
  std::sort(places.begin(), places.end());
  auto count = static_cast<std::uint32_t>(edges.count());
  std::vector<std::size_t> leaders;  // the first place of each part of an edge, in the order of their middles
  for (std::size_t k = 0; k < places.size(); ++k) {
    const Place& place = places[k];
    if (k == 0 || places[k - 1].edge != place.edge) leaders.clear();
    std::uint32_t found = no_id;
    for (std::size_t n = leaders.size(); n > 0 && found == no_id; --n) {
      const Place& leader = places[leaders[n - 1]];
      if (place.middle - leader.middle > 2 * place.reach) break;
      const SideCurve a = curve(place.border), b = curve(leader.border);
      if (std::min(distance_bound(a, b, false), distance_bound(a, b, true)) <= place.reach)
        found = numbers[leader.border];
    }
    if (found == no_id) {
      found = leaders.empty() ? place.edge : count++;
      leaders.push_back(k);
    }
    numbers[place.border] = found;
  }
  return {std::move(numbers), count};
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

}}  // namespace tessera::abi_0_1
