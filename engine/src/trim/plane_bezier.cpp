#include "trim/plane_bezier.h"

#include <cassert>
#include <cstddef>
#include <span>

#include "basis/bernstein.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// The products u w, v w and the weight w of a control point.
struct HomogeneousPoint {
  DoubleDouble u, v, w;
};
using HomogeneousNet = std::array<HomogeneousPoint, max_degree + 1>;

HomogeneousNet homogeneous(const PlaneBezier& curve) {
  HomogeneousNet net;
  for (std::size_t i = 0; i < curve.points.size(); ++i) {
    const double w = curve.weight(i);
    net[i] = {two_product(curve.points[i].u, w), two_product(curve.points[i].v, w), {w, 0}};
  }
  return net;
}

DoubleDouble mean(const DoubleDouble& s, const DoubleDouble& a, const DoubleDouble& t, const DoubleDouble& b) {
  return s * a + t * b;
}

/// Splits at t (de Casteljau): `net` becomes the part over [0, t] if `lower`, otherwise the part over [t, 1].
void split(HomogeneousNet& net, std::size_t count, bool rational, const DoubleDouble& t, bool lower) {
  const DoubleDouble s = DoubleDouble{1, 0} + DoubleDouble{-t.high, -t.low};
  const auto step = [&](const HomogeneousPoint& a, const HomogeneousPoint& b) {
    return HomogeneousPoint{mean(s, a.u, t, b.u), mean(s, a.v, t, b.v), rational ? mean(s, a.w, t, b.w) : a.w};
  };
  for (std::size_t level = 1; level < count; ++level) {
    if (lower)
      for (std::size_t i = count - 1; i >= level; --i) net[i] = step(net[i - 1], net[i]);
    else
      for (std::size_t i = 0; i + level < count; ++i) net[i] = step(net[i], net[i + 1]);
  }
}

/// Returns a / w with one rounding to double-double's 100 bits.
DoubleDouble quotient(const DoubleDouble& a, const DoubleDouble& w) {
  const double first = a.high / w.high;
  const DoubleDouble rest = a + w * -first;
  return two_sum(first, rest.high / w.high);
}

PrecisePoint projected(const HomogeneousPoint& p, bool rational) {
  if (!rational) return {p.u, p.v};
  return {quotient(p.u, p.w), quotient(p.v, p.w)};
}

/// The Bernstein coefficients, up to a positive factor, of the numerator of the derivative of one coordinate:
/// N' W - N W' = sum over i < j of (j - i) C(p,i) C(p,j) w_i w_j (x_j - x_i) t^(i+j-1) (1-t)^(2p-1-i-j), since
/// B_j' B_i - B_i' B_j = (j - i) B_i B_j / (t (1 - t)).
std::vector<double> derivative_numerator(const PlaneBezier& curve, double ParameterPoint::*coordinate) {
  const int p = curve.degree();
  const auto x = [&](int i) { return curve.points[static_cast<std::size_t>(i)].*coordinate; };
  if (curve.weights.empty()) {
    std::vector<double> c(static_cast<std::size_t>(p));
    for (int i = 0; i < p; ++i) c[static_cast<std::size_t>(i)] = x(i + 1) - x(i);
    return c;
  }
  const double largest = *std::max_element(curve.weights.begin(), curve.weights.end());
  const auto w = [&](int i) { return curve.weights[static_cast<std::size_t>(i)] / largest; };
  std::vector<double> c(static_cast<std::size_t>(2 * p - 1));
  for (int i = 0; i <= p; ++i)
    for (int j = i + 1; j <= p; ++j)
      c[static_cast<std::size_t>(i + j - 1)] += (j - i) * binomial(p, i) * binomial(p, j) * w(i) * w(j) * (x(j) - x(i));
  for (int k = 0; k < 2 * p - 1; ++k) c[static_cast<std::size_t>(k)] /= binomial(2 * p - 2, k);
  return c;
}

int sign_changes(const std::vector<double>& c, double noise) {
  int changes = 0, last = 0;
  for (const double value : c) {
    const int sign = value > noise ? 1 : value < -noise ? -1 : 0;
    if (sign == 0) continue;
    changes += last != 0 && sign != last;
    last = sign;
  }
  return changes;
}

/// Splits Bernstein coefficients at t: `c` keeps the part over [0, t], and the rest is returned.
std::vector<double> split(std::vector<double>& c, double t) {
  std::vector<double> upper = c;
  const std::size_t count = c.size();
  for (std::size_t level = 1; level < count; ++level) {
    for (std::size_t i = 0; i + level < count; ++i) upper[i] = (1 - t) * upper[i] + t * upper[i + 1];
    c[level] = upper[0];
  }
  return upper;
}

double value_at(const std::vector<double>& coefficients, double t) {
  std::array<double, 2 * max_degree> c;
  std::ranges::copy(coefficients, c.begin());
  for (std::size_t last = coefficients.size() - 1; last > 0; --last)
    for (std::size_t i = 0; i < last; ++i) c[i] = (1 - t) * c[i] + t * c[i + 1];
  return c[0];
}

/// The root of a polynomial whose coefficients change their sign once, as a share of the interval.
double only_root(const std::vector<double>& c, double noise) {
  double lower = 0, upper = 1;
  const auto first = std::find_if(c.begin(), c.end(), [&](double x) { return std::abs(x) > noise; });
  const double sign = *first > 0 ? 1 : -1;
  double f_lower = sign * c.front(), f_upper = sign * c.back();
  for (int k = 0; k < 100 && upper - lower > 0x1p-53; ++k) {
    double t = 0.5 * lower + 0.5 * upper;
    // Regula falsi in two of three steps.
    if (k % 3 != 2 && f_lower > 0 && f_upper < 0) t = lower + (upper - lower) * (f_lower / (f_lower - f_upper));
    if (!(t > lower && t < upper)) t = 0.5 * lower + 0.5 * upper;
    if (!(t > lower && t < upper)) break;
    const double f = sign * value_at(c, t);
    if (f == 0) return t;
    (f > 0 ? lower : upper) = t;
    (f > 0 ? f_lower : f_upper) = f;
  }
  return 0.5 * lower + 0.5 * upper;
}

/// Appends the roots in (from, to) of the polynomial with these coefficients over [from, to].
void append_roots(std::vector<double> c, double noise, double from, double to, int depth, std::vector<double>& roots) {
  const int changes = sign_changes(c, noise);
  if (changes == 0) return;
  if (changes == 1) {
    const double t = from + (to - from) * only_root(c, noise);
    if (t > from && t < to) roots.push_back(t);
    return;
  }
  const double middle = 0.5 * from + 0.5 * to;
  if (depth == 0) {  // several roots at a distance of rounding
    roots.push_back(middle);
    return;
  }
  const std::vector<double> upper = split(c, 0.5);
  append_roots(std::move(c), noise, from, middle, depth - 1, roots);
  if (std::abs(upper.front()) <= noise) roots.push_back(middle);
  append_roots(upper, noise, middle, to, depth - 1, roots);
}

/// Whether a coordinate of a control polygon never turns. Then that of the curve does not either.
bool is_monotone(std::span<const ParameterPoint> points, double ParameterPoint::*x) {
  bool rises = false, falls = false;
  for (std::size_t k = 1; k < points.size(); ++k) {
    rises = rises || points[k].*x > points[k - 1].*x;
    falls = falls || points[k].*x < points[k - 1].*x;
  }
  return !(rises && falls);
}

}  // namespace

PrecisePoint precise_point(const PlaneBezier& curve, double t) {
  if (t == 0 || t == 1) {
    const ParameterPoint& end = t == 0 ? curve.points.front() : curve.points.back();
    return {{end.u, 0}, {end.v, 0}};
  }
  HomogeneousNet net = homogeneous(curve);
  split(net, curve.points.size(), !curve.weights.empty(), {t, 0}, false);
  return projected(net[0], !curve.weights.empty());
}

PlaneBezier part(const PlaneBezier& curve, double t0, double t1) {
  assert(0 <= t0 && t0 < t1 && t1 <= 1);
  if (t0 == 0 && t1 == 1) return curve;
  const std::size_t count = curve.points.size();
  const bool rational = !curve.weights.empty();
  HomogeneousNet net = homogeneous(curve);
  if (t1 < 1) split(net, count, rational, {t1, 0}, true);
  if (t0 > 0) split(net, count, rational, t1 < 1 ? quotient({t0, 0}, {t1, 0}) : DoubleDouble{t0, 0}, false);
  PlaneBezier result;
  for (std::size_t i = 0; i < count; ++i) result.points.push_back(projected(net[i], rational).rounded());
  if (rational)
    for (std::size_t i = 0; i < count; ++i) result.weights.push_back(net[i].w.rounded());
  return result;
}

void append_extrema(const PlaneBezier& curve, int along, std::vector<double>& parameters) {
  if (is_monotone(curve.points, along == 0 ? &ParameterPoint::u : &ParameterPoint::v)) return;
  std::vector<double> c = derivative_numerator(curve, along == 0 ? &ParameterPoint::u : &ParameterPoint::v);
  double largest = 0;
  for (const double value : c) largest = std::max(largest, std::abs(value));
  const double noise = 8 * static_cast<double>(c.size()) * 0x1p-53 * largest;
  append_roots(std::move(c), noise, 0, 1, 26, parameters);
}

}}  // namespace tessera::abi_0_1
