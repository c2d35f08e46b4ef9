#include "io_occt/trim_curve.h"

#include <opencascade/Geom2dConvert.hxx>
#include <opencascade/Geom2d_BSplineCurve.hxx>
#include <opencascade/Geom2d_TrimmedCurve.hxx>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "convert/fit/cubic_fit.h"

namespace tessera::inline abi_0_1 {
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

bool is_straight_along_a_parameter(const Geom2d_BSplineCurve& spline) {
  if (spline.Degree() != 1 || spline.NbPoles() != 2) return false;
  const gp_Pnt2d a = spline.Pole(1), b = spline.Pole(2);
  const double du = std::abs(b.X() - a.X()), dv = std::abs(b.Y() - a.Y());
  return std::min(du, dv) <= 1e-12 * std::max(du, dv);
}

/// One knot interval of the spline, in our parameters.
class MappedSpan {
 public:
  MappedSpan(const Geom2d_BSplineCurve& spline, int span, const Reparametrization& parameters)
      : spline_(spline), span_(span), parameters_(parameters) {}

  CurveSample at(double t) const {
    gp_Pnt2d p;
    gp_Vec2d d;
    spline_.LocalD1(t, span_, span_ + 1, p, d);
    const std::array<double, 2> uv = parameters_(p.X(), p.Y());
    const double slope_u = parameters_.u ? parameters_.u->slope(p.X()) : 1,
                 slope_v = parameters_.v ? parameters_.v->slope(p.Y()) : 1;
    return {t, {uv[0], uv[1], 0}, {slope_u * d.X(), slope_v * d.Y(), 0}};
  }

 private:
  const Geom2d_BSplineCurve& spline_;
  int span_;
  const Reparametrization& parameters_;
};

Result<Curve> refitted(const Geom2d_BSplineCurve& spline, const Reparametrization& parameters, double tolerance) {
  CubicFit fit;
  const auto is_near = [&](const Vec3& a, const Vec3& b) { return length(a - b) <= tolerance; };
  for (int k = spline.FirstUKnotIndex(); k < spline.LastUKnotIndex(); ++k) {
    const MappedSpan span(spline, k, parameters);
    fit.follow([&](double t) { return span.at(t); }, is_near, spline.Knot(k), spline.Knot(k + 1));
  }
  return std::move(fit).curve();
}

}  // namespace

Result<Curve> trim_curve(const handle<Geom2d_Curve>& curve, const Interval& range, bool reversed,
                         const Reparametrization& parameters, double tolerance) {
  const handle<Geom2d_TrimmedCurve> part = new Geom2d_TrimmedCurve(curve, range.from, range.to);
  const handle<Geom2d_BSplineCurve> spline = Geom2dConvert::CurveToBSplineCurve(part);
  if (spline->IsPeriodic()) spline->SetNotPeriodic();
  if (reversed) spline->Reverse();
  if (parameters.is_identity() || is_straight_along_a_parameter(*spline)) return mapped_poles(*spline, parameters);
  return refitted(*spline, parameters, tolerance);
}

}  // namespace tessera::inline abi_0_1
