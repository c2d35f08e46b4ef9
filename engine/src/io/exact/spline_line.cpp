#include "io/exact/spline_line.h"

namespace tessera { inline namespace abi_0_1 {

SplineLine straight_line(const Vec3& start, const Vec3& end, const Interval& range) {
  return {1, {range.from, range.from, range.to, range.to}, {start, end}, {}, range, {}, 0};
}

SplineLine ellipse_arcs(const Vec3& centre, const Vec3& x, const Vec3& y, const Interval& range) {
  const Arcs arcs(range.from, range.to);
  SplineLine line{2, arcs.knots(), {}, {}, range, arcs, 0};
  for (const Arcs::Point& p : arcs.points()) {
    line.points.push_back(centre + (p.cosine * x + p.sine * y));
    line.weights.push_back(p.weight);
  }
  return line;
}

/// Its blossom gives the control points.
SplineLine parabola_arc(const Vec3& vertex, const Vec3& x, const Vec3& y, double focal, const Interval& range) {
  const auto blossom = [&](double s, double t) { return vertex + s * t / (4 * focal) * x + 0.5 * (s + t) * y; };
  const double a = range.from, b = range.to;
  return {2, {a, a, a, b, b, b}, {blossom(a, a), blossom(a, b), blossom(b, b)}, {}, range, {}, 0};
}

}}  // namespace tessera::abi_0_1
