#include "surface/callable/border_curve.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/text.h"
#include "surface/spline/spline_lines.h"
#include "tessera/guard.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Returns true if the (k-1)-th derivative is continuous within the part: the multiplicity of each knot there is at
/// most degree + 1 - k.
bool is_smooth(const Curve& curve, const Interval& part, int k) {
  for (const double knot : curve.knots()) {
    if (!(knot > part.from && knot < part.to)) continue;
    if (static_cast<int>(multiplicity(curve.knots(), knot)) > curve.degree() + 1 - k) return false;
  }
  return true;
}

/// A vector and a bound of its rounding error.
struct Rounded {
  Vec3 value;
  double error = 0;
};

/// Returns the control points of the k-th derivative (Piegl and Tiller, The NURBS Book, eq. 3.8). Points between equal
/// knots act nowhere. Each step rounds a point four times and magnifies the errors of the two points that it subtracts.
std::vector<Rounded> derivative_points(const Curve& curve, int k) {
  std::vector<Rounded> points;
  for (const Vec3& point : curve.points()) points.push_back({point});
  const std::size_t p = static_cast<std::size_t>(curve.degree());
  for (std::size_t order = 1; order <= static_cast<std::size_t>(k); ++order) {
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
      const double width = curve.knots()[i + p + 1] - curve.knots()[i + order];
      const double scale = width > 0 ? static_cast<double>(p - order + 1) / width : 0;
      const Vec3 value = scale * (points[i + 1].value - points[i].value);
      const double error = scale * (points[i].error + points[i + 1].error) + 0x1p-50 * length(value);
      points[i] = {value, error * (1 + 0x1p-40)};
    }
    points.pop_back();
  }
  return points;
}

double derivative_bound(const Curve& curve, const Interval& part, int k) {
  if (k > curve.degree() && !curve.is_rational()) return is_smooth(curve, part, k) ? 0 : infinity;
  if (k > 0 && (curve.is_rational() || !is_smooth(curve, part, k))) return infinity;
  const std::vector<Rounded> points = derivative_points(curve, k);
  const std::size_t p = static_cast<std::size_t>(curve.degree()), order = static_cast<std::size_t>(k);
  double bound = 0;
  for (const std::size_t span : distinct_spans(line_of(curve))) {
    if (curve.knots()[span] >= part.to || curve.knots()[span + 1] <= part.from) continue;
    for (std::size_t i = span - p; i + order <= span; ++i)
      bound = std::max(bound, length(points[i].value) + points[i].error);
  }
  return bound * (1 + 0x1p-40);  // covers the hull's own rounding
}

Status not_finite(double t) { return {StatusCode::non_finite, "the parameter is " + text(t) + ", it must be finite"}; }

Status named(const Status& status, const char* name) {
  return {status.code(), std::string(name) + ": " + status.message(), status.index()};
}

}  // namespace

double derivative_bound(const BorderCurve& border, const Interval& part, int k) {
  if (const auto* curve = std::get_if<Curve>(&border)) return derivative_bound(*curve, part, k);
  return std::get<ParametricCurve>(border).derivative_bound(part, k);
}

Result<Vec3> position(const BorderCurve& border, double t, const char* name) {
  Result<Vec3> point = position(border, t);
  if (!point) return named(point.status(), name);
  return point;
}

Result<CurveJet> evaluate_jet(const BorderCurve& border, double t, const char* name) {
  Result<CurveJet> jet = evaluate_jet(border, t);
  if (!jet) return named(jet.status(), name);
  return jet;
}

Status check_same_interval(const BorderCurve& a, const char* name_a, const BorderCurve& b, const char* name_b) {
  const Interval &d = domain(a), &e = domain(b);
  if (d == e) return {};
  return {StatusCode::invalid_argument, std::string(name_a) + " and " + name_b + " are on different intervals, [" +
                                            text(d.from) + ", " + text(d.to) + "] and [" + text(e.from) + ", " +
                                            text(e.to) + "]"};
}

const Interval& domain(const BorderCurve& border) {
  return std::visit([](const auto& curve) -> const Interval& { return curve.domain(); }, border);
}

Result<Vec3> position(const BorderCurve& border, double t) {
  if (!std::isfinite(t)) return guarded([&] { return not_finite(t); });
  if (const auto* curve = std::get_if<Curve>(&border)) return position(*curve, t);
  return std::get<ParametricCurve>(border).position(t);
}

Result<CurveJet> evaluate_jet(const BorderCurve& border, double t) {
  if (!std::isfinite(t)) return guarded([&] { return not_finite(t); });
  if (const auto* curve = std::get_if<Curve>(&border)) return evaluate_jet(*curve, t);
  return evaluate_jet(std::get<ParametricCurve>(border), t);
}

}}  // namespace tessera::abi_0_1
