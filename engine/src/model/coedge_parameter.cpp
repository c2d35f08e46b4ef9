#include "model/coedge_parameter.h"

#include <algorithm>
#include <cstddef>

namespace tessera { inline namespace abi_0_1 {

namespace {

/// The value of a table of degree 1 at s. Within a span it is a mean of the ends by weights (1 - x) w0 and x w1.
double value_at(const Curve& table, double s) {
  const auto points = table.points();
  const auto knots = table.knots().subspan(1, points.size());  // of the points
  const auto above = std::ranges::upper_bound(knots, s);
  const auto high =
      static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(above - knots.begin(), 1, std::ssize(knots) - 1));
  const std::size_t low = high - 1;
  const double x = knots[low] < knots[high] ? std::clamp((s - knots[low]) / (knots[high] - knots[low]), 0.0, 1.0) : 0;
  const double from = table.weight(low) * (1 - x), to = table.weight(high) * x;
  return (from * points[low].x + to * points[high].x) / (from + to);
}

}  // namespace

double tabled_curve_parameter(const Coedge& coedge, const Curve& curve, double s) {
  const Interval& d = curve.domain();
  return std::clamp(value_at(*coedge.parameter, s), d.from, d.to);
}

// The span of the table in which t lies is found by its points, which are monotone; see value_at().
double tabled_edge_parameter(const Coedge& coedge, double t) {
  const Curve& table = *coedge.parameter;
  const auto points = table.points();
  const bool grows = points.front().x <= points.back().x;
  std::size_t low = 0, high = points.size() - 1;
  while (high - low > 1) {
    const std::size_t middle = (low + high) / 2;
    ((points[middle].x <= t) == grows ? low : high) = middle;
  }
  const double s0 = table.knots()[low + 1], s1 = table.knots()[high + 1];
  const double from = table.weight(low) * (t - points[low].x), to = table.weight(high) * (points[high].x - t);
  const double x = from + to == 0 ? 0 : std::clamp(from / (from + to), 0.0, 1.0);
  return std::clamp(s0 + x * (s1 - s0), table.domain().from, table.domain().to);
}

}}  // namespace tessera::abi_0_1
