#include "occt/spline_line.h"

#include <opencascade/GeomAdaptor_Curve.hxx>
#include <opencascade/GeomConvert_ApproxCurve.hxx>
#include <opencascade/Geom_BSplineCurve.hxx>
#include <opencascade/Geom_BezierCurve.hxx>
#include <opencascade/Geom_TrimmedCurve.hxx>
#include <opencascade/gp_Circ.hxx>
#include <opencascade/gp_Elips.hxx>
#include <opencascade/gp_Parab.hxx>

#include <algorithm>
#include <cmath>
#include <mutex>

#include "occt/guarded_calls.h"
#include "occt/kind_of.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

using opencascade::handle;

SplineLine from_spline(const Geom_BSplineCurve& curve, const Interval& range) {
  const double period = curve.IsPeriodic() ? curve.Period() : 0;
  PoleLine line = unrolled({curve.Degree(), curve.NbPoles(), period}, curve.KnotSequence(), range);
  SplineLine out;
  out.degree = line.degree;
  out.points.reserve(line.poles.size());
  if (curve.IsRational()) out.weights.reserve(line.poles.size());
  for (const int pole : line.poles) {
    out.points.push_back(vec3(curve.Pole(pole + 1).XYZ()));
    if (curve.IsRational()) out.weights.push_back(curve.Weight(pole + 1));
  }
  out.range = covered(line.knots, line.degree, range);
  out.knots = std::move(line.knots);
  return out;
}

SplineLine from_bezier(const Geom_BezierCurve& curve, const Interval& range) {
  SplineLine out;
  out.degree = curve.Degree();
  for (int k = 1; k <= curve.NbPoles(); ++k) {
    out.points.push_back(vec3(curve.Pole(k).XYZ()));
    if (curve.IsRational()) out.weights.push_back(curve.Weight(k));
  }
  out.knots.assign(out.points.size(), 0);
  out.knots.resize(2 * out.points.size(), 1);
  out.range = {std::max(0.0, range.from), std::min(1.0, range.to)};
  return out;
}

Result<SplineLine> fitted(const handle<Geom_Curve>& curve, const Interval& range) {
  double length_bound = 0;
  gp_Pnt before = curve->Value(range.from);
  for (int k = 1; k <= 16; ++k) {
    const gp_Pnt point = curve->Value(range.from + (range.to - range.from) * k / 16);
    length_bound += point.Distance(before);
    before = point;
  }
  const std::lock_guard lock(approximation_mutex());
  const handle<Geom_Curve> part = new Geom_TrimmedCurve(curve, range.from, range.to);
  const GeomConvert_ApproxCurve fit(part, 1e-6 * length_bound, GeomAbs_C0, 200, 8);
  if (!fit.HasResult()) return Status(StatusCode::unsupported, "a curve that it is swept along cannot be fitted");
  SplineLine line = from_spline(*fit.Curve(), range);
  line.fit_error = fit.MaxError();
  for (int k = 0; k <= 200; ++k) {
    const double t = range.from + (range.to - range.from) * k / 200;
    line.fit_error = std::max(line.fit_error, curve->Value(t).Distance(fit.Curve()->Value(t)));
  }
  return line;
}

}  // namespace

PoleLine unrolled(const PoleCircle& circle, const TColStd_Array1OfReal& flat, const Interval& range) {
  PoleLine line;
  line.degree = circle.degree;
  if (circle.period == 0) {
    line.knots.assign(flat.begin(), flat.end());
    line.poles.reserve(static_cast<std::size_t>(circle.pole_count));
    for (int k = 0; k < circle.pole_count; ++k) line.poles.push_back(k);
    return line;
  }
  // flat[0] is the first knot of pole 0; each turn repeats all poles, one period on.
  const int count = circle.pole_count, p = circle.degree;
  const auto turn = [&](int k) { return static_cast<int>(std::floor(static_cast<double>(k) / count)); };
  const auto pole = [&](int k) { return k - count * turn(k); };
  const auto knot = [&](int k) { return flat.Value(flat.Lower() + pole(k)) + circle.period * turn(k); };
  const double tiny = 1e-12 * circle.period;
  int first = count * static_cast<int>(std::floor((range.from - knot(p)) / circle.period + 1e-12));
  while (knot(first + p + 1) <= range.from + tiny) ++first;
  for (int k = first;; ++k) {
    const double value = knot(k);
    // At the end of a turn, equal knots may differ by the rounding of the period.
    line.knots.push_back(!line.knots.empty() && value < line.knots.back() + tiny ? line.knots.back() : value);
    const int domain_end = k - p;  // the knot that ends the domain, if this one is the last
    if (domain_end > first + p && knot(domain_end) >= range.to - tiny) break;
  }
  for (int k = first; k < first + static_cast<int>(line.knots.size()) - p - 1; ++k) line.poles.push_back(pole(k));
  return line;
}

Result<SplineLine> spline_line(const handle<Geom_Curve>& given, const Interval& range) {
  handle<Geom_Curve> curve = given;
  while (const auto* const trimmed = kind_of<Geom_TrimmedCurve>(curve)) curve = trimmed->BasisCurve();
  if (const auto* const spline = kind_of<Geom_BSplineCurve>(curve)) return from_spline(*spline, range);
  if (const auto* const bezier = kind_of<Geom_BezierCurve>(curve)) return from_bezier(*bezier, range);
  const GeomAdaptor_Curve adaptor(curve);
  const auto arcs = [&](const gp_Ax2& axes, double major, double minor) {
    return ellipse_arcs(vec3(axes.Location().XYZ()), major * vec3(axes.XDirection().XYZ()),
                        minor * vec3(axes.YDirection().XYZ()), range);
  };
  switch (adaptor.GetType()) {
    case GeomAbs_Line:
      return straight_line(vec3(curve->Value(range.from).XYZ()), vec3(curve->Value(range.to).XYZ()), range);
    case GeomAbs_Circle:
      return arcs(adaptor.Circle().Position(), adaptor.Circle().Radius(), adaptor.Circle().Radius());
    case GeomAbs_Ellipse:
      return arcs(adaptor.Ellipse().Position(), adaptor.Ellipse().MajorRadius(), adaptor.Ellipse().MinorRadius());
    case GeomAbs_Parabola:
      return parabola_arc(vec3(adaptor.Parabola().Location().XYZ()), vec3(adaptor.Parabola().XAxis().Direction().XYZ()),
                          vec3(adaptor.Parabola().YAxis().Direction().XYZ()), adaptor.Parabola().Focal(), range);
    default:
      return fitted(curve, range);
  }
}

}}  // namespace tessera::abi_0_1
