#include "measure/strip_cell.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "measure/gauss_rule.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr int max_nodes = 14;
constexpr std::array ellipses{1.5, 2.0, 2.6, 3.4, 4.6, 6.5, 10.0, 20.0, 64.0};

double power(double x, int degree) { return degree == 0 ? 1 : degree == 1 ? x : x * x; }

/// The monomials by which both kinds of integrands are multiplied.
std::array<double, 10> monomials(const Vec3& r) {
  return {1, r.x, r.y, r.z, r.x * r.x, r.y * r.y, r.z * r.z, r.x * r.y, r.y * r.z, r.z * r.x};
}

}  // namespace

StripCell::StripCell(const StripPatch& patch, const CurveStrip& strip, const StripSquare& square, Integrand integrand)
    : patch_(patch), strip_(strip), square_(square), integrand_(integrand) {
  find_window();
  is_empty_ = !(half_u_ > 0) || !(half_v_ > 0);
  if (is_empty_) return;
  net_.emplace(patch.net.restricted(window_));
  series_.emplace(*net_, integrand == Integrand::area);
  curve_.emplace(square_.curve);
  real_ = integrand_bound(1, 1);
  if (integrand == Integrand::area) real_.value = bound_slack * series_->real_normal() / (4 * half_u_ * half_v_);
  magnitude_ = real_.value * parameter_area_;
}

void StripCell::find_window() {
  const ParameterPoint &from = square_.curve.start(), &to = square_.curve.end();
  const double base = strip_.base;
  const auto u_at = [&](double s, double u) { return std::clamp(base + s * (u - base), 0.0, 1.0); };
  const auto [low, high] =
      std::minmax({u_at(square_.s0, from.u), u_at(square_.s0, to.u), u_at(square_.s1, from.u), u_at(square_.s1, to.u)});
  const auto [below, above] = std::minmax({std::clamp(from.v, 0.0, 1.0), std::clamp(to.v, 0.0, 1.0)});
  window_ = {low, high, below, above};
  half_u_ = 0.5 * (high - low), half_v_ = 0.5 * (above - below);
  const double reach = std::max(std::abs(from.u - base), std::abs(to.u - base));
  parameter_area_ = (square_.s1 - square_.s0) * reach * (above - below) * bound_slack;
}

StripCell::Bound StripCell::integrand_bound(double reach_u, double reach_v) const {
  const NetSeries::Sizes size = series_->sizes(reach_u, reach_v);
  const double position = length(patch_.centre + series_->middle()) + size.position;
  // Derivatives are by the parameters of the window.
  double value = size.du * size.dv / (4 * half_u_ * half_v_);
  if (integrand_ == Integrand::flux) value *= position;
  return {value * bound_slack, position * bound_slack};
}

StripCell::Bound StripCell::bound(double reach_s, double reach_t) const {
  const CurveSeries::Disc disc = curve_->disc(reach_t);
  const ParameterPoint& centre = curve_->centre();
  const double s = 0.5 * (square_.s0 + square_.s1), half_s = 0.5 * (square_.s1 - square_.s0);
  const double far = std::abs(centre.u - strip_.base) + disc.u;
  const double u = strip_.base + s * (centre.u - strip_.base);
  const double off_u = std::abs(u - 0.5 * (window_.u0 + window_.u1)),
               off_v = std::abs(centre.v - 0.5 * (window_.v0 + window_.v1));
  const double reach_u = bound_slack * (off_u + s * disc.u + half_s * reach_s * far) / half_u_;
  const double reach_v = bound_slack * (off_v + disc.v) / half_v_;
  if (!(reach_u < 1e6) || !(reach_v < 1e6)) return {std::numeric_limits<double>::infinity(), 0};
  Bound all = integrand_bound(reach_u, reach_v);
  if (integrand_ == Integrand::area) all.value = series_->normal(reach_u, reach_v) / (4 * half_u_ * half_v_);
  all.value *= 2 * half_s * far * disc.v_speed * bound_slack;
  return all;
}

StripCell::Choice StripCell::choose(bool along_s, double tolerance) const {
  Choice best;
  const int most = integral_count(integrand_) == 4 ? 1 : 2;  // the highest degree of a moment
  for (const double rho : ellipses) {
    const double reach = ellipse_reach(rho);
    const Bound at = along_s ? bound(reach, 1) : bound(1, reach);
    if (!std::isfinite(at.value)) break;
    const double grown = power(std::max(1.0, at.position / real_.position), most);
    const GaussChoice choice = gauss_choice(at.value, rho, tolerance / grown);
    if (choice.count == 0 || choice.count > max_nodes) continue;
    if (best.nodes == 0 || choice.count < best.nodes) best = {choice.count, choice.error, at.position};
  }
  return best;
}

bool StripCell::is_longer_along_s() const {
  const NetSeries::Sizes size = series_->sizes(1, 1);
  const bool is_area = integrand_ == Integrand::area;
  double along_u = is_area ? series_->normal_turn(true) : size.du,
         along_v = is_area ? series_->normal_turn(false) : size.dv;
  constexpr double far_apart = 1.5;  // weights whose ratio is larger hide all else
  const double ratio_u = net_->weight_ratio(true), ratio_v = net_->weight_ratio(false);
  if (std::max(ratio_u, ratio_v) > far_apart) along_u = ratio_u - 1, along_v = ratio_v - 1;
  // The window's width comes from s, and from t where the curve moves in u.
  const double from = square_.curve.start().u, to = square_.curve.end().u, base = strip_.base;
  const double by_s = (square_.s1 - square_.s0) * std::max(std::abs(from - base), std::abs(to - base));
  const double by_t = 0.5 * (square_.s0 + square_.s1) * std::abs(to - from);
  return along_u * by_s >= along_u * by_t + along_v * 2 * half_u_;
}

std::optional<StripCell::Found> StripCell::integrate(double tolerance) {
  const Choice s = choose(true, 0.5 * tolerance), t = choose(false, 0.5 * tolerance);
  const bool both = (s.nodes == 0) == (t.nodes == 0);
  splits_s_ = both ? is_longer_along_s() : s.nodes == 0;
  // A half that still has half of the bound was cut in a direction that does not matter.
  if (both && magnitude_ > 0.45 * square_.whole_magnitude && square_.whole_magnitude > 0)
    splits_s_ = !square_.is_half_in_s;
  if (s.nodes == 0 || t.nodes == 0) return {};
  Found found;
  Integrals& all = found.integrals;
  found.magnitude = sum(s.nodes, t.nodes, all);
  for (int k = 0; k < integral_count(integrand_); ++k) {
    const int degree = moment_degree(k);
    all.error[static_cast<std::size_t>(k)] +=
        bound_slack * (s.error * power(s.position, degree) + t.error * power(t.position, degree));
  }
  add_rounding(all);
  if (!std::isfinite(all.error[0])) return {};  // the weight may vanish a quarter of the window farther on
  return found;
}

double StripCell::sum(int nodes_s, int nodes_t, Integrals& all) const {
  const GaussRule &along_s = gauss_rule(nodes_s), &along_t = gauss_rule(nodes_t);
  const double width = square_.s1 - square_.s0, base = strip_.base;
  const auto count = static_cast<std::size_t>(integral_count(integrand_));
  const double direction = square_.curve.end().v >= square_.curve.start().v ? 1 : -1;
  const double du = 2 * half_u_, dv = 2 * half_v_;
  double magnitude = 0;
  for (std::size_t j = 0; j < static_cast<std::size_t>(nodes_t); ++j) {
    const LocalCurvePoint at = square_.curve.at(along_t.nodes[j]);
    const LocalNet::Row row = net_->row(strip_.is_whole ? along_t.nodes[j] : (at.v - window_.v0) / dv);
    const double jacobian = strip_.is_whole ? 1 : direction * width * (at.u - base) * at.dv / (du * dv);
    const double scale = along_t.weights[j] * jacobian;
    for (std::size_t i = 0; i < static_cast<std::size_t>(nodes_s); ++i) {
      const double u = base + (square_.s0 + along_s.nodes[i] * width) * (at.u - base);
      const LocalNetPoint point = net_->at(row, strip_.is_whole ? along_s.nodes[i] : (u - window_.u0) / du);
      const Vec3 r = patch_.centre + point.position, normal = cross(point.du, point.dv);
      const double value = integrand_ == Integrand::area ? length(normal) : dot(r, normal);
      const double weighted = scale * along_s.weights[i] * value;
      const double scaled = integrand_ == Integrand::area ? value : length(r) * length(normal);
      magnitude += std::abs(scale) * along_s.weights[i] * scaled;
      const std::array<double, 10> moments = monomials(r);
      for (std::size_t k = 0; k < count; ++k) all.value[k] += weighted * moments[k];
    }
  }
  return magnitude;
}

void StripCell::add_rounding(Integrals& to) const {
  const NetRounding rounding = net_->rounding();
  const NetSeries::Sizes size = series_->sizes(1, 1);
  const double inverse = 1 / (4 * half_u_ * half_v_), unit = 0x1p-53;
  double value = (rounding.du * size.dv + size.du * rounding.dv + rounding.du * rounding.dv) * inverse;
  value += 16 * unit * size.du * size.dv * inverse;
  if (integrand_ == Integrand::flux)
    value = value * (real_.position + rounding.position) + size.du * size.dv * inverse * rounding.position;
  value *= parameter_area_;
  // Nodes, weights, the window and the curve are rounded: the integrand's derivatives follow from its bound a quarter
  // of the window farther on (Cauchy), the Jacobian's error from its factors.
  const Bound near = integrand_bound(1.25, 1.25);
  const double curve = strip_.is_whole ? 0 : square_.curve.rounding() + 8 * unit;
  const double at_nodes = near.value * 8 * (curve / half_u_ + curve / half_v_ + 16 * unit) * parameter_area_;
  const double steps = static_cast<double>(8 * square_.curve.degree() + 64) * unit;
  const double jacobian = near.value * (steps * parameter_area_ + curve * 4 * (half_u_ + half_v_) + curve * curve);
  value += at_nodes + jacobian;
  for (int k = 0; k < integral_count(integrand_); ++k) {
    const int degree = moment_degree(k);
    double error = value * power(near.position, degree);
    if (degree > 0) {  // the monomial is off by this share of |r|^degree
      const double share = degree * (rounding.position + 4 * unit * near.position);
      error += 2 * share * power(near.position, degree - 1) * real_.value * parameter_area_;
    }
    to.error[static_cast<std::size_t>(k)] += error;
  }
}

Integrals StripCell::crude() const {
  Integrals all;
  for (int k = 0; k < integral_count(integrand_); ++k)
    all.error[static_cast<std::size_t>(k)] = magnitude_ * power(real_.position, moment_degree(k));
  if (integrand_ == Integrand::area) {
    all.value[0] = 0.5 * magnitude_;
    all.error[0] = 0.5 * magnitude_;
  }
  return all;
}

std::pair<StripSquare, StripSquare> StripCell::halves() const {
  StripSquare first = square_, second = square_;
  if (splits_s_) {
    first.s1 = second.s0 = 0.5 * (square_.s0 + square_.s1);
  } else {
    std::tie(first.curve, second.curve) = square_.curve.halves();
  }
  first.whole_magnitude = second.whole_magnitude = magnitude_;
  first.is_half_in_s = second.is_half_in_s = splits_s_;
  return {std::move(first), std::move(second)};
}

void add_band(const StripPatch& patch, const CurveStrip& strip, Integrand integrand, ExactSums& sums) {
  const ParameterPoint &from = strip.curve.start(), &to = strip.curve.end(), &band = strip.band;
  const double width = std::abs(to.u - from.u), height = std::abs(to.v - from.v);
  const double area = 2 * (band.u * (height + 2 * band.v) + band.v * (width + 2 * band.u));
  if (!(area > 0)) return;
  constexpr double least = 0x1p-30;  // a window must have some extent
  const auto lower = [&](double a, double b, double by) { return std::clamp(std::min(a, b) - by - least, 0.0, 1.0); };
  const auto upper = [&](double a, double b, double by) { return std::clamp(std::max(a, b) + by + least, 0.0, 1.0); };
  const Domain window{lower(from.u, to.u, band.u), upper(from.u, to.u, band.u), lower(from.v, to.v, band.v),
                      upper(from.v, to.v, band.v)};
  const NetSeries series(patch.net.restricted(window), false);
  const NetSeries::Sizes size = series.sizes(1, 1);
  const double position = length(patch.centre + series.middle()) + size.position;
  double value = area * size.du * size.dv / ((window.u1 - window.u0) * (window.v1 - window.v0)) * bound_slack;
  if (integrand == Integrand::flux) value *= position;
  Integrals all;
  for (int k = 0; k < integral_count(integrand); ++k)
    all.error[static_cast<std::size_t>(k)] = value * power(position, moment_degree(k));
  sums.add(all, 1);
}

}}  // namespace tessera::abi_0_1
