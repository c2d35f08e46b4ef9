#include "occt/trim_curve.h"

#include <opencascade/Geom2d_Line.hxx>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "convert/fit/cubic_fit.h"
#include "exact/spline_jets.h"
#include "occt/kind_of.h"
#include "occt/plane_spline.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

using opencascade::handle;

bool is_straight_along_a_parameter(const ParameterPoint& a, const ParameterPoint& b) {
  const double du = std::abs(b.u - a.u), dv = std::abs(b.v - a.v);
  return std::min(du, dv) <= 1e-12 * std::max(du, dv);
}
ParameterPoint first_point(const SplineLine& line) { return {line.points.front().x, line.points.front().y}; }
ParameterPoint last_point(const SplineLine& line) { return {line.points.back().x, line.points.back().y}; }
bool is_straight_along_a_parameter(const SplineLine& line) {
  return line.degree == 1 && line.points.size() == 2 &&
         is_straight_along_a_parameter(first_point(line), last_point(line));
}

/// A spline in our parameters.
class MappedSpline {
 public:
  /// `same`: the line, as a curve in its own parameters.
  MappedSpline(const SplineLine& line, const Curve& same, const Reparametrization& parameters)
      : line_(line), same_(same), parameters_(parameters) {}

  CurveSample at(double t) const {
    const CurvePlace place = same_(t);
    return mapped(t, place.point, place.slope);
  }
  /// The end of the knot interval `span` at a knot of full multiplicity: the spline may have another slope after it.
  CurveSample corner_after(std::size_t span) const {
    const Vec3 &before = line_.points[span - 1], &corner = line_.points[span];
    const double t = line_.knots[span + 1], pace = line_.degree / (t - line_.knots[span]);
    return mapped(t, corner, pace * line_.weight(span - 1) / line_.weight(span) * (corner - before));
  }

 private:
  CurveSample mapped(double t, const Vec3& point, const Vec3& slope) const {
    const std::array<double, 2> uv = parameters_(point.x, point.y);
    const double slope_u = parameters_.u ? parameters_.u->slope(uv[0]) : 1,
                 slope_v = parameters_.v ? parameters_.v->slope(uv[1]) : 1;
    return {t, {uv[0], uv[1], 0}, {slope_u * slope.x, slope_v * slope.y, 0}};
  }

  const SplineLine& line_;
  FastCurve same_;
  const Reparametrization& parameters_;
};

/// Cubics that end where the spline may have a corner.
Result<Curve> refitted(const SplineLine& line, const Reparametrization& parameters, const ParameterPoint& tolerance) {
  const Result<Curve> same = curve_of(line);
  if (!same) return same.status();
  const MappedSpline mapped(line, *same, parameters);
  const auto at = [&](double t) { return mapped.at(t); };
  const auto is_near = [&](const Vec3& a, const Vec3& b) {
    return std::abs(a.x - b.x) <= tolerance.u && std::abs(a.y - b.y) <= tolerance.v;
  };
  CubicFit fit;
  std::vector<CurveSample> samples;
  const auto degree = static_cast<std::size_t>(line.degree), last = line.points.size();
  std::size_t span = degree, next = 0;  // knot intervals
  while (line.knots[span + 1] == line.knots[span]) ++span;
  for (; span < last; span = next) {
    const double from = line.knots[span], to = line.knots[span + 1];
    samples.push_back(at(from));
    samples.push_back(at(0.5 * (from + to)));
    for (next = span + 1; next < last && line.knots[next + 1] == to;) ++next;
    if (next < last && next - span < degree) continue;
    samples.push_back(next < last ? mapped.corner_after(span) : at(to));
    fit.follow(at, is_near, samples);
    samples.clear();
  }
  return std::move(fit).curve();
}

/// The line with its points mapped: correct if the map keeps the span of the points straight.
Result<Curve> with_mapped_points(SplineLine line, const Reparametrization& parameters) {
  if (!parameters.is_identity())
    for (Vec3& point : line.points) {
      const std::array<double, 2> uv = parameters(point.x, point.y);
      point = {uv[0], uv[1], 0};
    }
  return curve_of(line);
}

/// A line that stays one in our parameters, without the detour over splines: most edges are lines.
Result<TrimCurve> mapped_line(const ParameterPoint& a, const ParameterPoint& b, const Interval& range, bool reversed,
                              const Reparametrization& parameters) {
  const std::array<double, 2> start = parameters(a.u, a.v), end = parameters(b.u, b.v);
  const std::array points{Vec3{start[0], start[1], 0}, Vec3{end[0], end[1], 0}};
  const std::array knots{range.from, range.from, range.to, range.to};
  Result<Curve> made = Curve::b_spline(1, points, knots);
  if (!made) return made.status();
  TrimCurve out{*std::move(made), {range, 0, {}, reversed}};
  if (is_straight_along_a_parameter(a, b)) out.parameter.follow_line(a, b, parameters);
  return out;
}

}  // namespace

Result<TrimCurve> trim_curve(const handle<Geom2d_Curve>& curve, const Interval& range, bool reversed,
                             const Reparametrization& parameters, const ParameterPoint& tolerance) {
  const handle<Geom2d_Curve> bare = bare_curve(curve);
  const auto too_long = [] { return Status(StatusCode::unsupported, "an edge runs around more than once"); };
  if (bare->IsPeriodic() && range.to - range.from > (1 + 1e-9) * bare->Period()) return too_long();
  const auto* const straight_line = kind_of<Geom2d_Line>(bare);
  if (straight_line && range.from < range.to) {
    const gp_Pnt2d from = straight_line->Value(range.from), to = straight_line->Value(range.to);
    ParameterPoint a{from.X(), from.Y()}, b{to.X(), to.Y()};
    constexpr double most_arcs = 64;
    const auto is_long = [&](const std::optional<Arcs>& arcs, double way) {
      return arcs && std::abs(way) > most_arcs * arcs->step();
    };
    if (is_long(parameters.u, b.u - a.u) || is_long(parameters.v, b.v - a.v)) return too_long();
    if (reversed) std::swap(a, b);
    if (parameters.is_identity() || is_straight_along_a_parameter(a, b))
      return mapped_line(a, b, range, reversed, parameters);
  }
  Result<PlaneSpline> found = plane_spline(bare, range);
  if (!found) return found.status();
  SplineLine& line = found->line;
  if (reversed) reverse(line);
  CurveParameter parameter(line.range, found->shift, line.arcs, reversed);
  const bool straight = is_straight_along_a_parameter(line);
  if (straight) parameter.follow_line(first_point(line), last_point(line), parameters);
  Result<Curve> made = parameters.is_identity() || straight ? with_mapped_points(std::move(line), parameters)
                                                            : refitted(line, parameters, tolerance);
  if (!made) return made.status();
  return TrimCurve{*std::move(made), parameter};
}

}}  // namespace tessera::abi_0_1
