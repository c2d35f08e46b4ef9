#include "occt/trim_curve.h"

#include <opencascade/Geom2dConvert.hxx>
#include <opencascade/Geom2d_BSplineCurve.hxx>
#include <opencascade/Geom2d_BezierCurve.hxx>
#include <opencascade/Geom2d_Circle.hxx>
#include <opencascade/Geom2d_Ellipse.hxx>
#include <opencascade/Geom2d_Line.hxx>
#include <opencascade/Geom2d_OffsetCurve.hxx>
#include <opencascade/Geom2d_TrimmedCurve.hxx>

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <numbers>
#include <utility>

#include "base/text.h"
#include "convert/fit/cubic_fit.h"
#include "exact/spline_jets.h"
#include "occt/guarded_calls.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

using opencascade::handle;

/// The spline with its poles mapped: correct if the map keeps the span of the poles straight.
Result<Curve> mapped_poles(const Geom2d_BSplineCurve& spline, const Reparametrization& parameters) {
  std::vector<Vec3> points;
  std::vector<double> weights;
  for (int k = 1; k <= spline.NbPoles(); ++k) {
    const gp_Pnt2d pole = spline.Pole(k);
    const std::array<double, 2> uv = parameters(pole.X(), pole.Y());
    points.push_back({uv[0], uv[1], 0});
    if (spline.IsRational()) weights.push_back(spline.Weight(k));
  }
  const TColStd_Array1OfReal& flat = spline.KnotSequence();
  const std::vector<double> knots(flat.begin(), flat.end());
  return weights.empty() ? Curve::b_spline(spline.Degree(), points, knots)
                         : Curve::nurbs(spline.Degree(), points, weights, knots);
}

bool is_straight_along_a_parameter(const gp_Pnt2d& a, const gp_Pnt2d& b) {
  const double du = std::abs(b.X() - a.X()), dv = std::abs(b.Y() - a.Y());
  return std::min(du, dv) <= 1e-12 * std::max(du, dv);
}
bool is_straight_along_a_parameter(const Geom2d_BSplineCurve& spline) {
  return spline.Degree() == 1 && spline.NbPoles() == 2 && is_straight_along_a_parameter(spline.Pole(1), spline.Pole(2));
}

/// A spline in our parameters.
class MappedSpline {
 public:
  /// `same`: the spline, as one of ours in its own parameters.
  MappedSpline(const Geom2d_BSplineCurve& spline, const Curve& same, const Reparametrization& parameters)
      : spline_(spline), same_(same), parameters_(parameters) {}

  CurveSample at(double t) const {
    const CurvePlace place = same_(t);
    return mapped(t, place.point, place.slope);
  }
  /// The end of the knot interval `span`, where the spline may have another slope after it.
  CurveSample end_of(int span) const {
    gp_Pnt2d p;
    gp_Vec2d d;
    const double t = spline_.Knot(span + 1);
    spline_.LocalD1(t, span, span + 1, p, d);
    return mapped(t, {p.X(), p.Y(), 0}, {d.X(), d.Y(), 0});
  }

 private:
  CurveSample mapped(double t, const Vec3& point, const Vec3& slope) const {
    const std::array<double, 2> uv = parameters_(point.x, point.y);
    const double slope_u = parameters_.u ? parameters_.u->slope(uv[0]) : 1,
                 slope_v = parameters_.v ? parameters_.v->slope(uv[1]) : 1;
    return {t, {uv[0], uv[1], 0}, {slope_u * slope.x, slope_v * slope.y, 0}};
  }

  const Geom2d_BSplineCurve& spline_;
  FastCurve same_;
  const Reparametrization& parameters_;
};

/// Cubics that end where the spline may have a corner.
Result<Curve> refitted(const Geom2d_BSplineCurve& spline, const Reparametrization& parameters,
                       const ParameterPoint& tolerance) {
  const Result<Curve> same = mapped_poles(spline, {});
  if (!same) return same.status();
  const MappedSpline mapped(spline, *same, parameters);
  const auto at = [&](double t) { return mapped.at(t); };
  const auto is_near = [&](const Vec3& a, const Vec3& b) {
    return std::abs(a.x - b.x) <= tolerance.u && std::abs(a.y - b.y) <= tolerance.v;
  };
  CubicFit fit;
  std::vector<CurveSample> samples;
  const int last = spline.LastUKnotIndex();
  for (int k = spline.FirstUKnotIndex(); k < last; ++k) {
    const double from = spline.Knot(k), to = spline.Knot(k + 1);
    samples.push_back(at(from));
    samples.push_back(at(0.5 * (from + to)));
    if (k + 1 < last && spline.Multiplicity(k + 1) < spline.Degree()) continue;
    samples.push_back(mapped.end_of(k));
    fit.follow(at, is_near, samples);
    samples.clear();
  }
  return std::move(fit).curve();
}

handle<Geom2d_BSplineCurve> ellipse_spline(const gp_Ax22d& axes, double major, double minor, const Arcs& arcs) {
  const gp_XY x = major * axes.XDirection().XY(), y = minor * axes.YDirection().XY();
  const std::vector<Arcs::Point> points = arcs.points();
  const int count = static_cast<int>(points.size()), knot_count = count / 2 + 1;
  TColgp_Array1OfPnt2d poles(1, count);
  TColStd_Array1OfReal weights(1, count), knots(1, knot_count);
  TColStd_Array1OfInteger multiplicities(1, knot_count);
  for (int k = 0; k < count; ++k) {
    const Arcs::Point& p = points[static_cast<std::size_t>(k)];
    poles(k + 1) = gp_Pnt2d(axes.Location().XY() + p.cosine * x + p.sine * y);
    weights(k + 1) = p.weight;
  }
  const std::vector<double> all = arcs.knots();
  for (int k = 0; k < knot_count; ++k) {
    knots(k + 1) = all[static_cast<std::size_t>(2 * k + 1)];
    multiplicities(k + 1) = k == 0 || k + 1 == knot_count ? 3 : 2;
  }
  return new Geom2d_BSplineCurve(poles, weights, knots, multiplicities, 2);
}

/// A spline of the curve over a range, and how its parameter follows from the curve's.
struct PlaneSpline {
  handle<Geom2d_BSplineCurve> spline;
  std::optional<Arcs> arcs;  ///< empty: the parameters differ by `shift`
  double shift = 0;          ///< whole periods of the curve

  /// A spline that ends before the range has its end there.
  double parameter(double t) const {
    return arcs ? arcs->parameter(t) : std::clamp(t + shift, spline->FirstParameter(), spline->LastParameter());
  }
};

/// The part of a range for which the curve is stated: edges may be longer than their curves by rounding.
Interval stated_part(const Geom2d_Curve& curve, const Interval& range) {
  if (curve.IsPeriodic()) return range;
  return {std::max(range.from, curve.FirstParameter()), std::min(range.to, curve.LastParameter())};
}

Result<PlaneSpline> plane_spline(const handle<Geom2d_Curve>& curve, const Interval& range) {
  handle<Geom2d_Curve> whole = bare_curve(curve);
  const auto circle = handle<Geom2d_Circle>::DownCast(whole);
  const auto ellipse = handle<Geom2d_Ellipse>::DownCast(whole);
  const double turn = 2 * std::numbers::pi * (1 + 1e-12);
  if ((!circle.IsNull() || !ellipse.IsNull()) && range.from < range.to && range.to - range.from <= turn) {
    const Arcs arcs(range.from, range.to);
    if (!circle.IsNull())
      return PlaneSpline{ellipse_spline(circle->Position(), circle->Radius(), circle->Radius(), arcs), arcs};
    return PlaneSpline{ellipse_spline(ellipse->Position(), ellipse->MajorRadius(), ellipse->MinorRadius(), arcs), arcs};
  }
  // A part of a Bezier curve would become a spline from 0 to 1.
  if (whole->IsKind(STANDARD_TYPE(Geom2d_BezierCurve))) whole = Geom2dConvert::CurveToBSplineCurve(whole);
  const Interval part = stated_part(*whole, range);
  if (!(part.from < part.to))
    return Status(StatusCode::unsupported, "the curve of an edge in the face's parameters is stated from " +
                                               text(whole->FirstParameter()) + " to " + text(whole->LastParameter()) +
                                               ", the edge's range is from " + text(range.from) + " to " +
                                               text(range.to));
  std::unique_lock lock(approximation_mutex(), std::defer_lock);
  if (whole->IsKind(STANDARD_TYPE(Geom2d_OffsetCurve))) lock.lock();
  const handle<Geom2d_TrimmedCurve> trimmed = new Geom2d_TrimmedCurve(whole, part.from, part.to);
  PlaneSpline out{Geom2dConvert::CurveToBSplineCurve(trimmed), {}};
  if (out.spline->IsPeriodic()) out.spline->SetNotPeriodic();
  if (whole->IsPeriodic())
    out.shift = whole->Period() * std::round((out.spline->FirstParameter() - range.from) / whole->Period());
  return out;
}

/// The arcs that a straight line along one parameter runs through, and how far it goes.
struct ArcsOfLine {
  const Arcs* arcs = nullptr;  ///< null: none
  double from = 0, to = 0;     ///< OpenCASCADE's parameters of the surface at its ends
};
ArcsOfLine arcs_of_line(const gp_Pnt2d& a, const gp_Pnt2d& b, const Reparametrization& parameters) {
  const bool along_u = std::abs(b.X() - a.X()) > std::abs(b.Y() - a.Y());
  const std::optional<Arcs>& arcs = along_u ? parameters.u : parameters.v;
  return {arcs ? &*arcs : nullptr, along_u ? a.X() : a.Y(), along_u ? b.X() : b.Y()};
}

/// Where the knots of the arcs, and of those that follow them, lie along the line; from 0 to 1.
std::vector<double> places_of_knots(const ArcsOfLine& line) {
  std::vector<double> places;
  const double first = std::min(line.from, line.to), last = std::max(line.from, line.to);
  const double step = line.arcs->step();
  for (double k = std::ceil((first - line.arcs->from()) / step); line.arcs->from() + k * step < last; ++k)
    places.push_back((line.arcs->from() + k * step - line.from) / (line.to - line.from));
  std::sort(places.begin(), places.end());
  return places;
}

/// Describes a line from a to b along a parameter: at x from 0 to 1 of the line, the mapped line is at the parameter of
/// its arcs.
void follow_line(const gp_Pnt2d& a, const gp_Pnt2d& b, const Reparametrization& parameters, const Interval& range,
                 TrimCurve& out) {
  const ArcsOfLine line = arcs_of_line(a, b, parameters);
  if (!line.arcs) return;
  const Interval d = out.curve.domain();
  const double start = line.arcs->parameter(line.from), end = line.arcs->parameter(line.to);
  if (start == end) return;
  // The spline's own parameter is linear in OpenCASCADE's, and may run the other way.
  const auto place = [before = out.parameter, d](double t) { return (before(t) - d.from) / (d.to - d.from); };
  out.parameter = [place, d, start, end, from = line.from, to = line.to, arcs = *line.arcs](double t) {
    const double there = arcs.parameter(from + place(t) * (to - from));
    return d.from + (d.to - d.from) * (there - start) / (end - start);
  };
  const bool backwards = place(range.from) > place(range.to);
  for (const double x : places_of_knots(line))
    out.breaks.push_back(range.from + (backwards ? 1 - x : x) * (range.to - range.from));
  std::sort(out.breaks.begin(), out.breaks.end());
}

/// A line that stays one in our parameters, without the detour over OpenCASCADE's splines: most edges are lines.
Result<TrimCurve> mapped_line(const gp_Pnt2d& a, const gp_Pnt2d& b, const Interval& range, bool reversed,
                              const Reparametrization& parameters) {
  const std::array<double, 2> start = parameters(a.X(), a.Y()), end = parameters(b.X(), b.Y());
  const std::array points{Vec3{start[0], start[1], 0}, Vec3{end[0], end[1], 0}};
  const std::array knots{range.from, range.from, range.to, range.to};
  Result<Curve> made = Curve::b_spline(1, points, knots);
  if (!made) return made.status();
  TrimCurve out{*std::move(made), {}, {}, parameters.is_identity()};
  out.parameter = [range, reversed](double t) {
    const double within = std::clamp(t, range.from, range.to);
    return reversed ? range.from + range.to - within : within;
  };
  if (is_straight_along_a_parameter(a, b)) follow_line(a, b, parameters, range, out);
  return out;
}

}  // namespace

handle<Geom2d_Curve> bare_curve(handle<Geom2d_Curve> curve) {
  while (const auto trimmed = handle<Geom2d_TrimmedCurve>::DownCast(curve)) curve = trimmed->BasisCurve();
  return curve;
}

Result<TrimCurve> trim_curve(const handle<Geom2d_Curve>& curve, const Interval& range, bool reversed,
                             const Reparametrization& parameters, const ParameterPoint& tolerance) {
  const handle<Geom2d_Curve> bare = bare_curve(curve);
  const Status too_long(StatusCode::unsupported, "an edge runs around more than once");
  if (bare->IsPeriodic() && range.to - range.from > (1 + 1e-9) * bare->Period()) return too_long;
  const auto line = handle<Geom2d_Line>::DownCast(bare);
  if (!line.IsNull() && range.from < range.to) {
    gp_Pnt2d a = line->Value(range.from), b = line->Value(range.to);
    constexpr double most_arcs = 64;
    const auto is_long = [&](const std::optional<Arcs>& arcs, double way) {
      return arcs && std::abs(way) > most_arcs * arcs->step();
    };
    if (is_long(parameters.u, b.X() - a.X()) || is_long(parameters.v, b.Y() - a.Y())) return too_long;
    if (reversed) std::swap(a, b);
    if (parameters.is_identity() || is_straight_along_a_parameter(a, b))
      return mapped_line(a, b, range, reversed, parameters);
  }
  const Result<PlaneSpline> found = plane_spline(curve, range);
  if (!found) return found.status();
  const PlaneSpline& plane = *found;
  const handle<Geom2d_BSplineCurve>& spline = plane.spline;
  if (reversed) spline->Reverse();
  const bool straight = is_straight_along_a_parameter(*spline);
  Result<Curve> made = parameters.is_identity() || straight ? mapped_poles(*spline, parameters)
                                                            : refitted(*spline, parameters, tolerance);
  if (!made) return made.status();
  const double ends = spline->FirstParameter() + spline->LastParameter();
  TrimCurve out{*std::move(made), {}, {}, false};
  if (plane.arcs) out.breaks = plane.arcs->knots();
  out.parameter = [plane, reversed, ends](double t) {
    return reversed ? ends - plane.parameter(t) : plane.parameter(t);
  };
  if (straight) follow_line(spline->Pole(1), spline->Pole(2), parameters, range, out);
  return out;
}

}}  // namespace tessera::abi_0_1
