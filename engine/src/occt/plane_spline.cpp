#include "occt/plane_spline.h"

#include <opencascade/Geom2dConvert.hxx>
#include <opencascade/Geom2d_BSplineCurve.hxx>
#include <opencascade/Geom2d_BezierCurve.hxx>
#include <opencascade/Geom2d_Circle.hxx>
#include <opencascade/Geom2d_Ellipse.hxx>
#include <opencascade/Geom2d_OffsetCurve.hxx>
#include <opencascade/Geom2d_TrimmedCurve.hxx>

#include <algorithm>
#include <cmath>
#include <mutex>

#include "base/text.h"
#include "occt/guarded_calls.h"
#include "occt/kind_of.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

using opencascade::handle;

Vec3 in_plane(const gp_XY& of) { return {of.X(), of.Y(), 0}; }

SplineLine ellipse_line(const gp_Ax22d& axes, double major, double minor, const Interval& range) {
  return ellipse_arcs(in_plane(axes.Location().XY()), in_plane(major * axes.XDirection().XY()),
                      in_plane(minor * axes.YDirection().XY()), range);
}

/// The whole of a spline that is not periodic.
SplineLine spline_line(const Geom2d_BSplineCurve& spline) {
  SplineLine out;
  out.degree = spline.Degree();
  const TColStd_Array1OfReal& flat = spline.KnotSequence();
  out.knots.assign(flat.begin(), flat.end());
  const TColgp_Array1OfPnt2d& poles = spline.Poles();
  out.points.reserve(static_cast<std::size_t>(poles.Size()));
  for (const gp_Pnt2d& pole : poles) out.points.push_back(in_plane(pole.XY()));
  if (spline.IsRational()) out.weights.assign(spline.Weights()->begin(), spline.Weights()->end());
  out.range = {spline.FirstParameter(), spline.LastParameter()};
  return out;
}

/// The part of a range for which the curve is stated: edges may be longer than their curves by rounding.
Interval stated_part(const Geom2d_Curve& curve, const Interval& range) {
  if (curve.IsPeriodic()) return range;
  return {std::max(range.from, curve.FirstParameter()), std::min(range.to, curve.LastParameter())};
}

Result<PlaneSpline> part_of(const handle<Geom2d_Curve>& whole, const Interval& range) {
  const Interval part = stated_part(*whole, range);
  if (!(part.from < part.to))
    return Status(StatusCode::unsupported, "the curve of an edge in the face's parameters is stated from " +
                                               text(whole->FirstParameter()) + " to " + text(whole->LastParameter()) +
                                               ", the edge's range is from " + text(range.from) + " to " +
                                               text(range.to));
  const auto* const spline = kind_of<Geom2d_BSplineCurve>(whole);
  if (spline && !spline->IsPeriodic() && part == Interval{spline->FirstParameter(), spline->LastParameter()})
    return PlaneSpline{spline_line(*spline)};
  std::unique_lock lock(approximation_mutex(), std::defer_lock);
  if (whole->IsKind(STANDARD_TYPE(Geom2d_OffsetCurve))) lock.lock();
  const handle<Geom2d_TrimmedCurve> trimmed = new Geom2d_TrimmedCurve(whole, part.from, part.to);
  const handle<Geom2d_BSplineCurve> made = Geom2dConvert::CurveToBSplineCurve(trimmed);
  if (made->IsPeriodic()) made->SetNotPeriodic();
  PlaneSpline out{spline_line(*made)};
  if (whole->IsPeriodic())
    out.shift = whole->Period() * std::round((out.line.range.from - range.from) / whole->Period());
  return out;
}

}  // namespace

handle<Geom2d_Curve> bare_curve(handle<Geom2d_Curve> curve) {
  while (const auto* const trimmed = kind_of<Geom2d_TrimmedCurve>(curve)) curve = trimmed->BasisCurve();
  return curve;
}

Result<PlaneSpline> plane_spline(const handle<Geom2d_Curve>& curve, const Interval& range) {
  const handle<Geom2d_Curve> whole = bare_curve(curve);
  if (range.from < range.to && range.to - range.from <= full_turn * (1 + 1e-12)) {
    if (const auto* const circle = kind_of<Geom2d_Circle>(whole))
      return PlaneSpline{ellipse_line(circle->Position(), circle->Radius(), circle->Radius(), range)};
    if (const auto* const ellipse = kind_of<Geom2d_Ellipse>(whole))
      return PlaneSpline{ellipse_line(ellipse->Position(), ellipse->MajorRadius(), ellipse->MinorRadius(), range)};
  }
  // A part of a Bezier curve would become a spline from 0 to 1.
  if (kind_of<Geom2d_BezierCurve>(whole)) return part_of(Geom2dConvert::CurveToBSplineCurve(whole), range);
  return part_of(whole, range);
}

void reverse(SplineLine& line) {
  std::reverse(line.points.begin(), line.points.end());
  std::reverse(line.weights.begin(), line.weights.end());
  std::reverse(line.knots.begin(), line.knots.end());
  const auto [from, to] = line.range;  // which rounding would miss
  for (double& knot : line.knots) knot = knot == from ? to : knot == to ? from : from + to - knot;
}

}}  // namespace tessera::abi_0_1
