#include "exact/spline_line.h"

#include <algorithm>
#include <cmath>

namespace tessera { inline namespace abi_0_1 {

Result<Curve> curve_of(const SplineLine& line, const std::optional<Interval>& range) {
  const Interval part = range ? covered(line.knots, line.degree, *range) : line.range;
  return line.weights.empty() ? Curve::b_spline(line.degree, line.points, line.knots, part)
                              : Curve::nurbs(line.degree, line.points, line.weights, line.knots, part);
}

std::vector<double> breaks_of(std::span<const double> knots, const Interval& range) {
  std::vector<double> out{range.from};
  for (const double knot : knots)
    if (knot > out.back() && knot < range.to) out.push_back(knot);
  out.push_back(range.to);
  return out;
}

SplineLine straight_line(const Vec3& start, const Vec3& end, const Interval& range) {
  return {1, {range.from, range.from, range.to, range.to}, {start, end}, {}, range, {}, 0};
}

SplineLine ellipse_arcs(const Vec3& centre, const Vec3& x, const Vec3& y, const Interval& range) {
  const Arcs arcs(range.from, range.to);
  SplineLine line{2, arcs.knots(), {}, {}, range, arcs, 0};
  const std::vector<Arcs::Point> points = arcs.points();
  line.points.reserve(points.size());
  line.weights.reserve(points.size());
  for (const Arcs::Point& p : points) {
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

/// The tangents at a - h and a + h meet at centre + (cosh(a) x + sinh(a) y) / cosh(h), with the weight cosh(h).
SplineLine hyperbola_arcs(const Vec3& centre, const Vec3& x, const Vec3& y, const Interval& range) {
  const int count = std::max(1, static_cast<int>(std::ceil((range.to - range.from) / 1.5)));
  const double half = (range.to - range.from) / (2 * count);
  const auto at = [&](double t, double scale) {
    return centre + (std::cosh(t) / scale * x + std::sinh(t) / scale * y);
  };
  SplineLine line{2, {range.from, range.from, range.from}, {at(range.from, 1)}, {1}, range, {}, 0};
  for (int k = 0; k < count; ++k) {
    const double end = k + 1 == count ? range.to : range.from + 2 * half * (k + 1);
    line.points.push_back(at(range.from + half * (2 * k + 1), std::cosh(half)));
    line.points.push_back(at(end, 1));
    line.weights.push_back(std::cosh(half));
    line.weights.push_back(1);
    line.knots.insert(line.knots.end(), 2, end);
  }
  line.knots.push_back(range.to);
  return line;
}

Interval covered(std::span<const double> knots, int degree, const Interval& range) {
  const double tiny = 1e-12 * (range.to - range.from);
  const auto settled = [&](double end) {
    const auto knot = std::lower_bound(knots.begin(), knots.end(), end - tiny);
    return knot != knots.end() && *knot <= end + tiny ? *knot : end;
  };
  const auto p = static_cast<std::size_t>(degree);
  return {std::max(settled(range.from), knots[p]), std::min(settled(range.to), knots[knots.size() - p - 1])};
}

}}  // namespace tessera::abi_0_1
