#include "section/cell_net.h"

#include <cmath>
#include <limits>
#include <tuple>

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// The plane of a patch whose control points lie in one within rounding; negative distance: there is none.
std::pair<double, Vec3> plane_of(std::span<const Vec3> points, double rounding) {
  Vec3 along, normal;
  for (const Vec3& p : points)
    if (length(p - points[0]) > length(along)) along = p - points[0];
  for (const Vec3& p : points)
    if (const Vec3 found = cross(along, p - points[0]); length(found) > length(normal)) normal = found;
  normal = normalized(normal);
  if (normal == Vec3{}) return {-1, {}};
  double distance = 0;
  for (const Vec3& p : points) distance = std::max(distance, std::abs(dot(normal, p - points[0])));
  return {distance <= 16 * rounding ? distance : -1, normal};
}

template <class T>
void halve(std::vector<T>& lower, std::vector<T>& upper, std::size_t first, std::size_t step, std::size_t count) {
  for (std::size_t last = count; last-- > 0;) {
    const T start = upper[first];
    for (std::size_t i = 0; i < last; ++i)
      upper[first + i * step] = 0.5 * upper[first + i * step] + 0.5 * upper[first + (i + 1) * step];
    lower[first + (count - 1 - last) * step] = start;
  }
}

}  // namespace

/// Coefficients of the derivative of weight * (height - plane).
struct CellNet::Slopes {
  double least = infinity, most = -infinity;
  /// How far from 0 all of them are, on one side.
  double distance() const { return std::max({0.0, least, -most}); }
  double size() const { return std::max(std::abs(least), std::abs(most)); }
  /// Whether the height never falls, or never rises.
  bool is_one_sided(double rounding) const { return least >= -rounding || most <= rounding; }
};

/// Bounds on the lengths of derivatives.
struct CellNet::Sizes {
  double u = 0, v = 0, uu = 0, uv = 0, vv = 0;
  double radius = 0, largest_weight = 1;
  double net_uu = 0, net_uv = 0, net_vv = 0;  ///< of the net alone
};

CellNet::CellNet(const BezierPatch& patch, const Levels& levels)
    : m_(patch.degree_u()), n_(patch.degree_v()), weights_(patch.weights().begin(), patch.weights().end()) {
  points_.reserve(patch.points().size());
  for (const Vec3& p : patch.points()) points_.push_back(p - levels.origin);
  std::tie(flat_, flat_normal_) = plane_of(points_, levels.rounding);
  heights_.reserve(points_.size());
  for (std::size_t k = 0; k < points_.size(); ++k) {
    heights_.push_back(weight(k) * levels.height(patch.points()[k]));
    points_[k] = weight(k) * points_[k];
  }
}

CellNet CellNet::take_upper_half(bool along_u) {
  CellNet upper = *this;
  const std::size_t count = static_cast<std::size_t>(along_u ? m_ : n_) + 1;
  const std::size_t lines = static_cast<std::size_t>(along_u ? n_ : m_) + 1;
  for (std::size_t line = 0; line < lines; ++line) {
    const std::size_t first = along_u ? line : line * count, step = along_u ? lines : 1;
    halve(points_, upper.points_, first, step, count);
    halve(heights_, upper.heights_, first, step, count);
    if (!weights_.empty()) halve(weights_, upper.weights_, first, step, count);
  }
  return upper;
}

std::pair<std::vector<double>, std::vector<double>> CellNet::upper_side(bool along_u) const {
  std::pair<std::vector<double>, std::vector<double>> side;
  for (int k = 0; k <= (along_u ? n_ : m_); ++k) {
    const std::size_t at = along_u ? index(m_, k) : index(k, n_);
    side.first.push_back(heights_[at]);
    if (!weights_.empty()) side.second.push_back(weights_[at]);
  }
  return side;
}

CellNet::Slopes CellNet::slopes(bool along_u, double lowest, double highest) const {
  Slopes slopes;
  const double degree = along_u ? m_ : n_;
  for (int i = 0; i + (along_u ? 1 : 0) <= m_; ++i)
    for (int j = 0; j + (along_u ? 0 : 1) <= n_; ++j) {
      const std::size_t a = index(i, j), b = along_u ? index(i + 1, j) : index(i, j + 1);
      const double step = heights_[b] - heights_[a], weights = weight(b) - weight(a);
      for (const double height : {lowest, highest}) {
        const double slope = degree * (step - height * weights);
        slopes.least = std::min(slopes.least, slope), slopes.most = std::max(slopes.most, slope);
        if (weights == 0) break;
      }
    }
  return slopes;
}

CellNet::Sizes CellNet::sizes() const {
  Sizes of;
  Box3 box;
  double w_min = infinity, w_max = 0, w_u = 0, w_v = 0, w_uu = 0, w_uv = 0, w_vv = 0;
  for (std::size_t k = 0; k < points_.size(); ++k) {
    box.extend((1 / weight(k)) * points_[k]);
    w_min = std::min(w_min, weight(k)), w_max = std::max(w_max, weight(k));
  }
  const Vec3 centre = box.centre();
  of.radius = 0.5 * box.diagonal();
  const auto point = [&](int i, int j) { return points_[index(i, j)] - weight(index(i, j)) * centre; };
  const auto w = [&](int i, int j) { return weight(index(i, j)); };
  const double m = m_, n = n_;
  for (int i = 0; i <= m_; ++i)
    for (int j = 0; j <= n_; ++j) {
      const auto most = [](double& size, double found) { size = std::max(size, found); };
      if (i < m_) most(of.u, m * length(point(i + 1, j) - point(i, j)));
      if (j < n_) most(of.v, n * length(point(i, j + 1) - point(i, j)));
      if (i + 2 <= m_) most(of.net_uu, m * (m - 1) * length(point(i + 2, j) - 2 * point(i + 1, j) + point(i, j)));
      if (j + 2 <= n_) most(of.net_vv, n * (n - 1) * length(point(i, j + 2) - 2 * point(i, j + 1) + point(i, j)));
      if (i < m_ && j < n_)
        most(of.net_uv, m * n * length(point(i + 1, j + 1) - point(i + 1, j) - point(i, j + 1) + point(i, j)));
      if (weights_.empty()) continue;
      if (i < m_) most(w_u, m * std::abs(w(i + 1, j) - w(i, j)));
      if (j < n_) most(w_v, n * std::abs(w(i, j + 1) - w(i, j)));
      if (i + 2 <= m_) most(w_uu, m * (m - 1) * std::abs(w(i + 2, j) - 2 * w(i + 1, j) + w(i, j)));
      if (j + 2 <= n_) most(w_vv, n * (n - 1) * std::abs(w(i, j + 2) - 2 * w(i, j + 1) + w(i, j)));
      if (i < m_ && j < n_) most(w_uv, m * n * std::abs(w(i + 1, j + 1) - w(i + 1, j) - w(i, j + 1) + w(i, j)));
    }
  const double r = of.radius;
  of.largest_weight = w_max;
  of.u = (of.u + r * w_u) / w_min;
  of.v = (of.v + r * w_v) / w_min;
  of.uu = (of.net_uu + 2 * of.u * w_u + r * w_uu) / w_min;
  of.vv = (of.net_vv + 2 * of.v * w_v + r * w_vv) / w_min;
  of.uv = (of.net_uv + of.u * w_v + of.v * w_u + r * w_uv) / w_min;
  return of;
}

/// Whether the height is the same along u (or v): equal control heights, and weights that are products a_i b_j.
bool CellNet::is_constant_along(bool along_u, double contact) const {
  for (int i = 0; i <= m_; ++i)
    for (int j = 0; j <= n_; ++j) {
      const std::size_t k = index(i, j), first = along_u ? index(0, j) : index(i, 0);
      if (std::abs(heights_[k] / weight(k) - heights_[first] / weight(first)) > contact) return false;
      const double product = weight(index(i, 0)) * weight(index(0, j)), other = weight(k) * weight(0);
      if (std::abs(product - other) > 0x1p-46 * other) return false;
    }
  return true;
}

void CellNet::choose(CellFacts& facts, const Levels& levels, double lowest, double highest) const {
  const Slopes along_u = slopes(true, lowest, highest), along_v = slopes(false, lowest, highest);
  const Sizes of = sizes();
  facts.bending = infinity;
  double least = infinity;
  // A steep graph is a poor one even where it needs few chords: places along it are found to fewer digits.
  const auto take = [&](CellKind kind, double bending, double turn) {
    const double cost = bending + 8 * levels.chord * turn * turn;
    if (cost < least) facts.kind = kind, facts.bending = bending, least = cost;
  };
  const auto take_graph = [&](CellKind kind, const Slopes& across, const Slopes& along, double size,
                              double second_across, double second_along) {
    const double slope = across.distance();
    if (!(slope > 0)) return;
    const double turn = along.size() / slope;
    const double bent = second_across * turn * turn + 2 * of.uv * turn + second_along;
    take(kind, bent * std::max(1.0, size * of.largest_weight / slope), turn);
  };
  take_graph(CellKind::over_v, along_u, along_v, of.u, of.uu, of.vv);
  take_graph(CellKind::over_u, along_v, along_u, of.v, of.vv, of.uu);
  if (is_constant_along(false, 0.25 * levels.contact)) take(CellKind::along_v, of.vv, 0);
  if (is_constant_along(true, 0.25 * levels.contact)) take(CellKind::along_u, of.uu, 0);
  if (facts.diameter <= levels.chord && std::isinf(facts.bending)) {
    // Chords this short need no proof of their distance, and the order of points along a graph none of its slope.
    if (along_u.is_one_sided(levels.rounding)) facts.kind = CellKind::over_v;
    if (along_v.is_one_sided(levels.rounding)) facts.kind = CellKind::over_u;
  }
  const double sine = length(cross(levels.normal, flat_normal_));
  if (flat_ >= 0 && sine > 0x1p-8 && std::isfinite(facts.bending)) facts.bending = 0, facts.slack = flat_ / sine;
  facts.divide_u = of.net_uu + of.u / 64 > of.net_vv + of.v / 64;
}

CellFacts CellNet::facts(const Levels& levels) const {
  CellFacts facts;
  Box3 box;
  facts.low = infinity, facts.high = -infinity;
  for (std::size_t k = 0; k < points_.size(); ++k) {
    const double height = heights_[k] / weight(k);
    facts.low = std::min(facts.low, height), facts.high = std::max(facts.high, height);
    box.extend((1 / weight(k)) * points_[k]);
  }
  facts.diameter = box.diagonal();
  const std::span<const double> near = levels.within(facts.low, facts.high);
  if (near.empty()) return facts;
  facts.kind = CellKind::open;
  choose(facts, levels, near.front(), near.back());
  return facts;
}

}}  // namespace tessera::abi_0_1
