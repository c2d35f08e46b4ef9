#include "io/exact/spline_jets.h"

#include <algorithm>
#include <cstddef>
#include <span>

#include "tessera/bezier_patch.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// The basis functions that are not zero at a parameter, and their derivatives.
struct Basis {
  std::size_t first = 0;  ///< of the first function
  std::array<double, max_degree + 1> values, slopes;  ///< as many as the degree and one; the rest is not set
};

/// Cox and de Boor's recurrence (Piegl and Tiller, The NURBS Book, 2nd ed., algorithms A2.1 to A2.3).
void evaluate_basis(std::span<const double> knots, int degree, double t, Basis& out) {
  const auto p = static_cast<std::size_t>(degree), last = knots.size() - p - 1;
  const auto above = std::upper_bound(knots.begin() + degree + 1, knots.begin() + static_cast<std::ptrdiff_t>(last), t);
  std::size_t span = static_cast<std::size_t>(above - knots.begin()) - 1;
  while (span > p && knots[span] == knots[span + 1]) --span;  // at the end of a domain before a multiple knot
  out.first = span - p;
  std::array<double, max_degree + 1> left, right, lower;  // not set: this is the innermost of all searches
  out.values[0] = 1;
  for (std::size_t j = 1; j <= p; ++j) {
    left[j] = t - knots[span + 1 - j];
    right[j] = knots[span + j] - t;
    if (j == p) std::copy_n(out.values.begin(), p, lower.begin());
    double saved = 0;
    for (std::size_t r = 0; r < j; ++r) {
      const double share = out.values[r] / (right[r + 1] + left[j - r]);
      out.values[r] = saved + right[r + 1] * share;
      saved = left[j - r] * share;
    }
    out.values[j] = saved;
  }
  // The derivative is p (N[i] / (t[i+p] - t[i]) - N[i+1] / (t[i+p+1] - t[i+1])) of the degree below.
  double before = 0;
  for (std::size_t r = 0; r <= p; ++r) {
    double share = 0;
    if (r < p) share = static_cast<double>(degree) * lower[r] / (knots[span + 1 + r] - knots[span + 1 + r - p]);
    out.slopes[r] = before - share;
    before = share;
  }
}

}  // namespace

FastCurve::FastCurve(const Curve& curve) : curve_(curve) {}

CurvePlace FastCurve::operator()(double t) const {
  const Interval d = curve_.domain();
  Basis basis;
  evaluate_basis(curve_.knots(), curve_.degree(), std::clamp(t, d.from, d.to), basis);
  const auto p = static_cast<std::size_t>(curve_.degree());
  CurvePlace out;
  double weight = 0, slope = 0;
  for (std::size_t k = 0; k <= p; ++k) {
    const std::size_t i = basis.first + k;
    const double w = curve_.weight(i);
    out.point += (w * basis.values[k]) * curve_.points()[i];
    out.slope += (w * basis.slopes[k]) * curve_.points()[i];
    weight += w * basis.values[k], slope += w * basis.slopes[k];
  }
  if (!curve_.is_rational()) return out;
  out.point = (1 / weight) * out.point;
  out.slope = (1 / weight) * (out.slope - slope * out.point);
  return out;
}

FastSurface::FastSurface(const BSplineSurface& surface) : surface_(surface) {}

SurfacePlace FastSurface::operator()(double u, double v) const {
  const Domain& d = surface_.domain();
  Basis in_u, in_v;
  evaluate_basis(surface_.knots_u(), surface_.degree_u(), std::clamp(u, d.u0, d.u1), in_u);
  evaluate_basis(surface_.knots_v(), surface_.degree_v(), std::clamp(v, d.v0, d.v1), in_v);
  const auto p = static_cast<std::size_t>(surface_.degree_u()), q = static_cast<std::size_t>(surface_.degree_v());
  const std::size_t row = surface_.count_v();
  const bool is_rational = surface_.is_rational();
  SurfacePlace out;
  double weight = 0, weight_u = 0, weight_v = 0;
  for (std::size_t i = 0; i <= p; ++i) {
    const std::size_t begin = (in_u.first + i) * row + in_v.first;
    const Vec3* const points = surface_.points().data() + begin;
    const double* const weights = is_rational ? surface_.weights().data() + begin : nullptr;
    Vec3 value, slope;
    double w = 0, w_slope = 0;
    for (std::size_t j = 0; j <= q; ++j) {
      const double scale = weights ? weights[j] : 1, a = scale * in_v.values[j], b = scale * in_v.slopes[j];
      value += a * points[j], slope += b * points[j];
      w += a, w_slope += b;
    }
    out.point += in_u.values[i] * value;
    out.du += in_u.slopes[i] * value;
    out.dv += in_u.values[i] * slope;
    weight += in_u.values[i] * w, weight_u += in_u.slopes[i] * w, weight_v += in_u.values[i] * w_slope;
  }
  if (!is_rational) return out;
  out.point = (1 / weight) * out.point;
  out.du = (1 / weight) * (out.du - weight_u * out.point);
  out.dv = (1 / weight) * (out.dv - weight_v * out.point);
  return out;
}

}}  // namespace tessera::abi_0_1
