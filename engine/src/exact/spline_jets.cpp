#include "exact/spline_jets.h"

#include <algorithm>
#include <array>

#include "tessera/bezier_patch.h"

namespace tessera { inline namespace abi_0_1 {

FastBasis::FastBasis(std::span<const double> knots, int degree, double from, double to)
    : knots_(knots), degree_(static_cast<std::size_t>(degree)), from_(from), to_(to) {
  const std::size_t spans = knots.size() - 2 * degree_ - 1;
  reciprocals_.reserve(spans * degree_ * (degree_ + 1) / 2);
  for (std::size_t span = degree_; span < degree_ + spans; ++span)
    for (std::size_t j = 1; j <= degree_; ++j)
      for (std::size_t r = 0; r < j; ++r) {
        const double width = knots[span + r + 1] - knots[span + 1 + r - j];
        reciprocals_.push_back(width > 0 ? 1 / width : 0);
      }
}

std::size_t FastBasis::span_of(double t) const {
  const std::size_t last = knots_.size() - degree_ - 1;
  const auto begin = knots_.begin() + static_cast<std::ptrdiff_t>(degree_) + 1;
  const auto above = std::upper_bound(begin, knots_.begin() + static_cast<std::ptrdiff_t>(last), t);
  std::size_t span = static_cast<std::size_t>(above - knots_.begin()) - 1;
  while (span > degree_ && knots_[span] == knots_[span + 1]) --span;  // the end of the knots
  return span;
}

/// Cox and de Boor's recurrence (Piegl and Tiller, The NURBS Book, 2nd ed., algorithms A2.1 to A2.3).
std::size_t FastBasis::evaluate(double t, double* values, double* slopes) const {
  t = std::clamp(t, from_, to_);
  const std::size_t p = degree_, span = span_of(t);
  const double* reciprocal = reciprocals_.data() + (span - p) * (p * (p + 1) / 2);
  const double* const knots = knots_.data() + span;
  values[0] = 1;
  for (std::size_t j = 1; j <= p; ++j) {
    // The derivative is p times the differences of the functions of the degree below, over their widths.
    double saved = 0, before = 0;
    const bool is_last = j == p;
    for (std::size_t r = 0; r < j; ++r, ++reciprocal) {
      const double share = values[r] * *reciprocal;
      values[r] = saved + (knots[r + 1] - t) * share;
      saved = (t - knots[static_cast<std::ptrdiff_t>(r) + 1 - static_cast<std::ptrdiff_t>(j)]) * share;
      if (is_last) slopes[r] = static_cast<double>(p) * (before - share), before = share;
    }
    values[j] = saved;
    if (is_last) slopes[p] = static_cast<double>(p) * before;
  }
  return span - p;
}

FastCurve::FastCurve(const Curve& curve)
    : curve_(curve), basis_(curve_.knots(), curve_.degree(), curve_.domain().from, curve_.domain().to) {}

CurvePlace FastCurve::operator()(double t) const {
  std::array<double, max_degree + 1> values, slopes;
  const std::size_t first = basis_.evaluate(t, values.data(), slopes.data());
  const auto p = static_cast<std::size_t>(curve_.degree());
  const Vec3* const points = curve_.points().data() + first;
  const double* const weights = curve_.is_rational() ? curve_.weights().data() + first : nullptr;
  CurvePlace out;
  double weight = 0, slope = 0;
  for (std::size_t k = 0; k <= p; ++k) {
    const double w = weights ? weights[k] : 1, a = w * values[k], b = w * slopes[k];
    out.point += a * points[k], out.slope += b * points[k];
    weight += a, slope += b;
  }
  if (!weights) return out;
  out.point = (1 / weight) * out.point;
  out.slope = (1 / weight) * (out.slope - slope * out.point);
  return out;
}

FastSurface::FastSurface(const BSplineSurface& surface)
    : surface_(surface),
      in_u_(surface_.knots_u(), surface_.degree_u(), surface_.domain().u0, surface_.domain().u1),
      in_v_(surface_.knots_v(), surface_.degree_v(), surface_.domain().v0, surface_.domain().v1) {
  const std::span<const double> weights = surface_.weights();
  points_.reserve(surface_.points().size());
  for (const Vec3& p : surface_.points()) {
    const double w = weights.empty() ? 1 : weights[points_.size()];
    points_.push_back({w * p.x, w * p.y, w * p.z, w});
  }
}

SurfacePlace FastSurface::operator()(double u, double v) const {
  using Sum = std::array<double, 4>;
  std::array<double, max_degree + 1> values_u, slopes_u, values_v, slopes_v;
  const std::size_t first_u = in_u_.evaluate(u, values_u.data(), slopes_u.data());
  const std::size_t first_v = in_v_.evaluate(v, values_v.data(), slopes_v.data());
  const auto p = static_cast<std::size_t>(surface_.degree_u()), q = static_cast<std::size_t>(surface_.degree_v());
  const auto add = [](Sum& sum, double share, const Sum& of) {
    for (std::size_t c = 0; c < 4; ++c) sum[c] += share * of[c];
  };
  Sum point{}, along_u{}, along_v{};
  for (std::size_t i = 0; i <= p; ++i) {
    const Sum* const row = points_.data() + (first_u + i) * surface_.count_v() + first_v;
    Sum value{}, slope{};
    for (std::size_t j = 0; j <= q; ++j) add(value, values_v[j], row[j]), add(slope, slopes_v[j], row[j]);
    add(point, values_u[i], value), add(along_u, slopes_u[i], value), add(along_v, values_u[i], slope);
  }
  const auto vector = [](const Sum& sum) { return Vec3{sum[0], sum[1], sum[2]}; };
  SurfacePlace out{vector(point), vector(along_u), vector(along_v)};
  if (!surface_.is_rational()) return out;
  const double over = 1 / point[3];
  out.point = over * out.point;
  out.du = over * (out.du - along_u[3] * out.point);
  out.dv = over * (out.dv - along_v[3] * out.point);
  return out;
}

}}  // namespace tessera::abi_0_1
