#include "tessera/parametric_surface.h"

#include <array>
#include <string>

#include "base/text.h"
#include "surface/callable/callables.h"
#include "surface/callable/differences.h"
#include "surface/net/checks.h"
#include "tessera/guard.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

auto place_at(double t) {
  return [t] { return "the curve at t = " + text(t); };
}

Status not_finite(const std::string& what, double t, const Vec3& p) {
  return {StatusCode::non_finite, what + " at t = " + text(t) + " is (" + text(p.x) + ", " + text(p.y) + ", " +
                                      text(p.z) + "), it must be finite"};
}

Status check_jet(const CurveJet& jet, double t) {
  if (!is_finite(jet.position)) return not_finite("the curve", t, jet.position);
  if (!is_finite(jet.first)) return not_finite("the curve's first derivative", t, jet.first);
  if (!is_finite(jet.second)) return not_finite("the curve's second derivative", t, jet.second);
  return {};
}

/// Estimates the jet from the values at parameters around t.
Result<CurveJet> jet_by_differences(const ParametricCurve& curve, double t) {
  const DifferenceStencil stencil(t, curve.domain().from, curve.domain().to);
  const auto middle = curve.position(t);
  if (!middle) return middle.status();
  std::array<Vec3, DifferenceStencil::size> points;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const auto point = curve.position(stencil.at[k]);
    if (!point) return point.status();
    points[k] = *point;
  }
  return CurveJet{*middle, stencil.derivative(stencil.first, points, *middle),
                  stencil.derivative(stencil.second, points, *middle)};
}

}  // namespace

ParametricCurve::ParametricCurve(Data data) : data_(std::make_shared<const Data>(std::move(data))) {}

Result<ParametricCurve> ParametricCurve::make(CurveFunctions functions, const Interval& domain) {
  return guarded([&]() -> Result<ParametricCurve> {
    if (!functions.position) return Status(StatusCode::invalid_argument, "the curve has no function for its position");
    if (Status status = check_interval(domain.from, domain.to, "the curve's interval"); !status.ok()) return status;
    ParametricCurve curve({std::move(functions), domain});
    for (const double end : {domain.from, domain.to})
      if (const auto point = curve.position(end); !point) return point.status();
    return curve;
  });
}

Result<Vec3> ParametricCurve::position(double t) const {
  return guarded([&]() -> Result<Vec3> {
    Result<Vec3> point = called([&] { return data_->functions.position(t); }, place_at(t));
    if (point && !is_finite(*point)) return not_finite("the curve", t, *point);
    return point;
  });
}

double ParametricCurve::derivative_bound(const Interval& part, int k) const {
  return bound_of([&] {
    return has_bounds() ? data_->functions.derivative_bound(part, k) : std::numeric_limits<double>::infinity();
  });
}

Result<CurveJet> evaluate_jet(const ParametricCurve& curve, double t) {
  return guarded([&]() -> Result<CurveJet> {
    Result<CurveJet> jet = curve.has_derivatives() ? called([&] { return curve.data_->functions.jet(t); }, place_at(t))
                                                   : jet_by_differences(curve, t);
    if (!jet) return jet;
    if (Status status = check_jet(*jet, t); !status.ok()) return status;
    return jet;
  });
}

}}  // namespace tessera::abi_0_1
