#include "measure/local_curve.h"

#include <cmath>
#include <limits>

namespace tessera { inline namespace abi_0_1 {

LocalCurve::LocalCurve(const ParameterPoint& from, const ParameterPoint& to) : start_(from), end_(to) {
  u_[1] = to.u - from.u, v_[1] = to.v - from.v;
  w_[0] = w_[1] = 1;
}

LocalCurve::LocalCurve(const PlaneBezier& curve, const Domain& patch)
    : degree_(curve.degree()), is_rational_(!curve.weights.empty()) {
  const auto local = [&](const ParameterPoint& p) { return ParameterPoint{patch.local_u(p.u), patch.local_v(p.v)}; };
  start_ = local(curve.points.front()), end_ = local(curve.points.back());
  for (std::size_t i = 0; i < curve.points.size(); ++i) {
    const ParameterPoint p = local(curve.points[i]);
    w_[i] = curve.weight(i);
    u_[i] = w_[i] * (p.u - start_.u), v_[i] = w_[i] * (p.v - start_.v);
  }
  // The differences to the patch's sides are exact to a rounding of the parameters themselves.
  const double largest = std::max(std::max(std::abs(patch.u0), std::abs(patch.u1)) / (patch.u1 - patch.u0),
                                  std::max(std::abs(patch.v0), std::abs(patch.v1)) / (patch.v1 - patch.v0));
  rounding_ = (8 * degree_ + 16) * 0x1p-53 + 4 * 0x1p-53 * std::max(1.0, largest);
}

LocalCurvePoint LocalCurve::at(double t) const {
  Values u = u_, v = v_, w = w_;
  const double s = 1 - t;
  const auto n = static_cast<std::size_t>(degree_);
  for (std::size_t last = n; last > 1; --last)
    for (std::size_t i = 0; i < last; ++i) {
      u[i] = s * u[i] + t * u[i + 1];
      v[i] = s * v[i] + t * v[i + 1];
      if (is_rational_) w[i] = s * w[i] + t * w[i + 1];
    }
  const double du = degree_ * (u[1] - u[0]), dv = degree_ * (v[1] - v[0]);
  const double pu = s * u[0] + t * u[1], pv = s * v[0] + t * v[1];
  if (!is_rational_) return {start_.u + pu, start_.v + pv, du, dv};
  const double pw = s * w[0] + t * w[1], dw = degree_ * (w[1] - w[0]);
  return {start_.u + pu / pw, start_.v + pv / pw, (du - pu / pw * dw) / pw, (dv - pv / pw * dw) / pw};
}

LocalCurve::Slopes LocalCurve::slopes() const {
  // C' = (A' - C W') / W with C relative to the start, which monotone curves leave by no more than to their end.
  const auto n = static_cast<std::size_t>(degree_);
  double least = w_[0], most = w_[0], weight_slope = 0;
  for (std::size_t i = 1; i <= n; ++i) {
    least = std::min(least, w_[i]), most = std::max(most, w_[i]);
    weight_slope = std::max(weight_slope, std::abs(w_[i] - w_[i - 1]));
  }
  const auto range = [&](const Values& values, double reach) {
    double low = values[1] - values[0], high = low;
    for (std::size_t i = 1; i < n; ++i)
      low = std::min(low, values[i + 1] - values[i]), high = std::max(high, values[i + 1] - values[i]);
    const double slack = std::abs(reach) * weight_slope + 0x1p-48 * (std::abs(reach) + std::abs(low) + std::abs(high));
    low = degree_ * (low - slack), high = degree_ * (high + slack);
    return ScalarRange{low / (low < 0 ? least : most), high / (high > 0 ? least : most)};
  };
  return {range(u_, end_.u - start_.u), range(v_, end_.v - start_.v)};
}

std::pair<LocalCurve, LocalCurve> LocalCurve::halves() const {
  LocalCurve left = *this, right = *this;
  const auto n = static_cast<std::size_t>(degree_);
  for (Values LocalCurve::*const of : {&LocalCurve::u_, &LocalCurve::v_, &LocalCurve::w_}) {
    Values &low = left.*of, &high = right.*of;
    for (std::size_t k = 0; k <= n; ++k) {
      low[k] = high[0];
      for (std::size_t i = 0; i + k < n; ++i) high[i] = 0.5 * high[i] + 0.5 * high[i + 1];
    }
  }
  const double mu = left.u_[n] / left.w_[n], mv = left.v_[n] / left.w_[n];
  left.end_ = right.start_ = {start_.u + mu, start_.v + mv};
  for (std::size_t i = 0; i <= n; ++i) {
    right.u_[i] -= mu * right.w_[i];
    right.v_[i] -= mv * right.w_[i];
  }
  left.rounding_ = right.rounding_ = rounding_ + (4 * degree_ + 8) * 0x1p-53;
  return {left, right};
}

CurveSeries::CurveSeries(const LocalCurve& curve) : degree_(curve.degree_) {
  const PowerMatrix& matrix = centred_power(degree_);
  const auto count = static_cast<std::size_t>(degree_) + 1;
  for (std::size_t k = 0; k < count; ++k)
    for (std::size_t i = 0; i < count; ++i) {
      u_[k] += matrix[k][i] * curve.u_[i];
      v_[k] += matrix[k][i] * curve.v_[i];
      w_[k] += matrix[k][i] * curve.w_[i];
    }
  const double u = u_[0] / w_[0], v = v_[0] / w_[0];
  for (std::size_t k = 0; k < count; ++k) u_[k] -= u * w_[k], v_[k] -= v * w_[k];
  if (curve.is_rational_ == false)
    for (std::size_t k = 1; k < count; ++k) w_[k] = 0;
  centre_ = {curve.start_.u + u, curve.start_.v + v};
}

CurveSeries::Disc CurveSeries::disc(double reach) const {
  double u = 0, v = 0, w = 0, dv = 0, dw = 0, power = 1;
  for (std::size_t k = 1; k <= static_cast<std::size_t>(degree_); ++k) {
    dv += 2 * static_cast<double>(k) * std::abs(v_[k]) * power;
    dw += 2 * static_cast<double>(k) * std::abs(w_[k]) * power;
    power *= reach;
    u += std::abs(u_[k]) * power, v += std::abs(v_[k]) * power, w += std::abs(w_[k]) * power;
  }
  constexpr double rounding = 0x1p-46;  // of sums of at most 16 products, and of the centre
  const double low = w_[0] * (1 - rounding) - bound_slack * w;
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if (!(low > 0)) return {infinity, infinity, infinity};
  const double to_v = bound_slack * v / low;
  constexpr double of_centre = 0x1p-51;
  return {bound_slack * u / low * (1 + rounding) + of_centre, to_v * (1 + rounding) + of_centre,
          bound_slack * (dv + to_v * dw) / low * (1 + rounding)};
}

}}  // namespace tessera::abi_0_1
