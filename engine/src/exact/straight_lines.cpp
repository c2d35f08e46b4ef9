#include "exact/straight_lines.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace tessera { inline namespace abi_0_1 {
namespace {

/// The lines of a net along one direction.
struct NetLines {
  std::size_t lines, count;      ///< and of control points on each
  std::size_t next_line, along;  ///< the steps from a line to the next, and from a point to the next on its line

  std::size_t at(std::size_t line, std::size_t k) const { return line * next_line + k * along; }
};

/// Where the control points of a line lie that runs at the pace of its parameter.
std::vector<double> greville(const SplineDirection& of, std::size_t count) {
  std::vector<double> places;
  for (std::size_t k = 0; k < count; ++k) {
    double sum = 0;
    for (std::size_t j = 1; j <= static_cast<std::size_t>(of.degree); ++j) sum += of.knots[k + j];
    places.push_back(sum / of.degree);
  }
  return places;
}

Vec3 between(const Vec3& a, const Vec3& b, double x) { return (1 - x) * a + x * b; }

bool are_straight(const StraightenedNet& net, const NetLines& of, const std::vector<double>& places, double tolerance) {
  const double from = places.front(), width = places.back() - from;
  if (!(width > 0)) return false;
  for (std::size_t line = 0; line < of.lines; ++line) {
    const Vec3 &first = net.points[of.at(line, 0)], &last = net.points[of.at(line, of.count - 1)];
    for (std::size_t k = 1; k < of.count; ++k) {
      const std::size_t at = of.at(line, k);
      if (!net.weights.empty() && net.weights[at] != net.weights[of.at(line, 0)]) return false;
      if (!(max_abs(net.points[at] - between(first, last, (places[k] - from) / width)) <= tolerance)) return false;
    }
  }
  return true;
}

/// Shortens the lines along a direction, if they are straight.
void shorten(StraightenedNet& net, bool along_u, double tolerance) {
  SplineDirection& own = along_u ? net.u : net.v;
  const std::size_t count_u = net.u.knots.size() - static_cast<std::size_t>(net.u.degree) - 1,
                    count_v = net.points.size() / count_u;
  const NetLines of = along_u ? NetLines{count_v, count_u, 1, count_v} : NetLines{count_u, count_v, count_v, 1};
  if (of.count <= 2) return;
  const std::vector<double> places = greville(own, of.count);
  if (!are_straight(net, of, places, tolerance)) return;
  std::vector<Vec3> points(2 * of.lines);
  std::vector<double> weights(net.weights.empty() ? 0 : points.size());
  const NetLines to = along_u ? NetLines{of.lines, 2, 1, of.lines} : NetLines{of.lines, 2, 2, 1};
  for (std::size_t line = 0; line < of.lines; ++line)
    for (const std::size_t k : {0, 1}) {
      const double x = ((k == 0 ? own.part.from : own.part.to) - places.front()) / (places.back() - places.front());
      points[to.at(line, k)] = between(net.points[of.at(line, 0)], net.points[of.at(line, of.count - 1)], x);
      if (!weights.empty()) weights[to.at(line, k)] = net.weights[of.at(line, 0)];
    }
  own.degree = 1;
  own.knots = {own.part.from, own.part.from, own.part.to, own.part.to};
  net.points = std::move(points);
  net.weights = std::move(weights);
}

}  // namespace

void shorten_straight_lines(StraightenedNet& net) {
  double size = 0;
  for (const Vec3& p : net.points) size = std::max(size, max_abs(p));
  for (const bool along_u : {true, false}) shorten(net, along_u, 0x1p-44 * size);
}

}}  // namespace tessera::abi_0_1
