#include "join/curve_splits.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "base/point_tree.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr int max_rounds = 8;
/// Points within a cell of this share of the distance stand for one another.
constexpr double cell_share = 1.0 / 16;

/// Leaves one point of each cell, the least by its coordinates.
std::vector<Vec3> one_per_cell(std::vector<Vec3> points, double cell) {
  const auto place = [&](const Vec3& p) {
    return std::tuple(std::floor(p.x / cell), std::floor(p.y / cell), std::floor(p.z / cell));
  };
  const auto order = [&](const Vec3& p) { return std::tuple(place(p), p.x, p.y, p.z); };
  std::sort(points.begin(), points.end(), [&](const Vec3& a, const Vec3& b) { return order(a) < order(b); });
  points.erase(
      std::unique(points.begin(), points.end(), [&](const Vec3& a, const Vec3& b) { return place(a) == place(b); }),
      points.end());
  return points;
}

/// Parameters of a curve's sharp corners: knots of full multiplicity at which it turns by more than 17 degrees.
std::vector<double> corners_of(const SpaceCurve& curve) {
  constexpr double max_turn_cosine = 0.955;
  constexpr double step = 1e-4;  // of a knot span
  const std::span<const double> knots = curve.curve().knots();
  const Interval& d = curve.domain();
  std::vector<double> corners;
  for (std::size_t k = 0, next = 0; k < knots.size(); k = next) {
    while (next < knots.size() && knots[next] == knots[k]) ++next;
    if (!(knots[k] > d.from && knots[k] < d.to) || next - k < static_cast<std::size_t>(curve.curve().degree()))
      continue;
    const Vec3 at = curve.at(knots[k]);
    const Vec3 before = at - curve.at(knots[k] - step * (knots[k] - knots[k - 1])),
               after = curve.at(knots[k] + step * (knots[next] - knots[k])) - at;
    if (dot(before, after) < max_turn_cosine * length(before) * length(after)) corners.push_back(knots[k]);
  }
  return corners;
}

/// Divides one curve.
class Divider {
 public:
  Divider(FreeCurve& curve, std::span<const double> corners) : curve_(curve), corners_(corners) {}

  /// Parameters near points of the tree that are not near a node.
  std::vector<double> parameters_near(const PointTree& tree, std::span<const Vec3> points) const {
    const double reach = curve_.reach;
    std::vector<double> found;
    const std::span<const SpaceCurve::Sample> samples = curve_.curve.samples();
    for (std::size_t k = 0; k + 1 < samples.size(); ++k) {
      const Vec3 &a = samples[k].point, &b = samples[k + 1].point;
      const double wide = reach + SpaceCurve::max_sagitta * length(b - a);
      Box3 box;
      box.extend(a);
      box.extend(b);
      box.lower = box.lower - Vec3{wide, wide, wide};
      box.upper = box.upper + Vec3{wide, wide, wide};
      tree.visit_box(box, [&](std::uint32_t id) {
        const Vec3& p = points[id];
        const double x = nearest_fraction(a, b, p);
        if (length((1 - x) * a + x * b - p) > wide || is_near_node(p)) return;
        const SpaceCurve::Nearest nearest =
            curve_.curve.nearest_from(p, (1 - x) * samples[k].t + x * samples[k + 1].t, curve_.curve.domain());
        if (nearest.distance <= reach) found.push_back(nearest.t);
      });
    }
    std::sort(found.begin(), found.end());
    return found;
  }

  /// Makes nodes of parameters in order. Returns the points of the new ones.
  std::vector<Vec3> divide(std::span<const double> parameters, std::vector<BrepVertex>& vertices) {
    std::vector<Vec3> added;
    for (std::size_t k = 0, next = 0; k < parameters.size(); k = next) {
      const Vec3 first = curve_.curve.at(parameters[k]);
      for (next = k + 1; next < parameters.size(); ++next)
        if (length(curve_.curve.at(parameters[next]) - first) > curve_.reach) break;
      const double t = at_corner(0.5 * (parameters[k] + parameters[next - 1]));
      const Vec3 point = curve_.curve.at(t);
      if (is_near_node(point)) continue;
      const auto place = std::upper_bound(curve_.nodes.begin(), curve_.nodes.end(), t,
                                          [](double a, const CurveNode& node) { return a < node.t; });
      curve_.nodes.insert(place, {t, point, static_cast<std::uint32_t>(vertices.size())});
      vertices.push_back({point});
      added.push_back(point);
    }
    return added;
  }

 private:
  bool is_near_node(const Vec3& p) const {
    return std::any_of(curve_.nodes.begin(), curve_.nodes.end(),
                       [&](const CurveNode& node) { return length(node.point - p) <= curve_.reach; });
  }

  /// The corner near t, or t itself.
  double at_corner(double t) const {
    if (corners_.empty()) return t;
    const Vec3 point = curve_.curve.at(t);
    double nearest = curve_.reach, at = t;
    for (const double corner : corners_) {
      const double distance = length(curve_.curve.at(corner) - point);
      if (distance > nearest) continue;
      nearest = distance;
      at = corner;
    }
    return at;
  }

  FreeCurve& curve_;
  std::span<const double> corners_;
};

}  // namespace

void split_curves(FreeCurves& free, std::vector<BrepVertex>& vertices) {
  std::vector<std::vector<double>> corners;
  std::vector<Vec3> points;
  for (const FreeCurve& curve : free.curves) {
    corners.push_back(corners_of(curve.curve));
    for (const CurveNode& node : curve.nodes) points.push_back(node.point);
    for (const double corner : corners.back()) points.push_back(curve.curve.at(corner));
  }
  for (int round = 0; round < max_rounds && !points.empty(); ++round) {
    points = one_per_cell(std::move(points), cell_share * free.distance);
    const PointTree tree(points);
    std::vector<Vec3> added;
    for (std::size_t k = 0; k < free.curves.size(); ++k) {
      Divider divider(free.curves[k], corners[k]);
      const std::vector<Vec3> more = divider.divide(divider.parameters_near(tree, points), vertices);
      added.insert(added.end(), more.begin(), more.end());
    }
    points = std::move(added);
  }
}

}}  // namespace tessera::abi_0_1
