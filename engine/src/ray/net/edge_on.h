#pragma once
// Bounds of the roots in a box for which x and y together decide nothing, as next to a silhouette.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "ray/net/projected_net.h"
#include "ray/net/root_certificate.h"

namespace tessera { inline namespace abi_0_1 {

/// Two combinations of x and y at a right angle, g = a x + b y and h = a y - b x. g grows the fastest along p = u or v,
/// and h does not grow along p in the mean. Parameters are the box's own, relative to a point where g nearly vanishes:
/// P = p - p0, and Q = q - 1/2 for the other parameter q. A root has g = h = 0, except for noise.
///
/// With s = g_q / g_p at that point and P = e - s Q, e is the root's distance from g's tangent.
/// 1. By the mean value theorem
///   e = -(g(0) + (g_q - s g_p) Q) / g_p
/// with derivatives from their hulls.
/// 2. By Taylor's theorem along the straight line to the root
///   h = h(0) + (h_q - s h_p) Q + h_p e + (h_qq - 2 s h_pq + s^2 h_pp) Q^2 / 2 + (h_pq - s h_pp) Q e + h_pp e^2 / 2
/// with first derivatives at that point and second ones from their hulls.
/// 3. About a silhouette this is a parabola in Q, which bounds Q where its second derivative has one sign.
class EdgeOn {
 public:
  /// `reach`: how large |x| and |y| of a point that counts as a root may be; `rounding`: error of coefficients;
  /// `degree`: the larger one.
  EdgeOn(const DerivativeHulls& x, const DerivativeHulls& y, int degree, double reach, double rounding)
      : x_(x),
        y_(y),
        noise_(1.5 * (reach + rounding)),
        slope_noise_(3 * degree * rounding),
        bend_noise_(6 * degree * degree * rounding) {
    by_u_ = squared(x.u, y.u) >= squared(x.v, y.v);
    const Hull &xp = by_u_ ? x.u : x.v, &yp = by_u_ ? y.u : y.v;
    length_ = std::sqrt(squared(xp, yp));
    if (!(length_ > 0)) return;
    a_ = xp.centre() / length_, b_ = yp.centre() / length_;
    min_length_ = length_ - (std::abs(a_) * xp.radius() + std::abs(b_) * yp.radius() + slope_noise_);
  }

  /// Returns whether g grows along p in the whole box. If not, nothing else is known.
  bool grows() const { return min_length_ > 0.01 * length_; }

  /// Bounds the roots. `value` returns the net's value and derivatives at a point.
  template <class Shape, class Value>
  RootBox roots(const Shape& shape, const double* net, const Value& value) const {
    NetParameters at{0.5, 0.5};
    NetValue f = value(at);
    double& p0 = by_u_ ? at.u : at.v;
    p0 = std::clamp(0.5 - (a_ * f.x + b_ * f.y) / (by_u_ ? a_ * f.xu + b_ * f.yu : a_ * f.xv + b_ * f.yv), 0.0, 1.0);
    f = value(at);
    const double xp = by_u_ ? f.xu : f.xv, yp = by_u_ ? f.yu : f.yv, xq = by_u_ ? f.xv : f.xu, yq = by_u_ ? f.yv : f.yu;
    const double g = std::abs(a_ * f.x + b_ * f.y) + noise_, s = (a_ * xq + b_ * yq) / (a_ * xp + b_ * yp);
    const double turn = turn_of(s);
    const double hp = a_ * yp - b_ * xp, e = (g + 0.5 * turn) / min_length_;
    double h = a_ * f.y - b_ * f.x, slope = a_ * yq - b_ * xq - s * hp;
    const Bends bends = bends_of(shape, net);
    const Hull aslant = sum(bends.pq, -s, bends.pp);
    Hull bend = sum(sum(bends.qq, -2 * s, bends.pq), s * s, bends.pp);
    if (bend.high < 0) bend = {-bend.high, -bend.low}, h = -h, slope = -slope;
    double first = -0.5, last = 0.5;  // range of Q
    if (const double least = bend.low - (1 + s * s) * 2 * bend_noise_; least > 0) {
      const double off = (std::abs(hp) + slope_noise_ + 0.5 * (aslant.largest() + (1 + std::abs(s)) * bend_noise_) +
                          0.5 * e * (bends.pp.largest() + bend_noise_)) *
                             e +
                         noise_ + (1 + std::abs(s)) * slope_noise_;
      const double inside = slope * slope - 2 * least * (h - off);
      if (inside < 0) return nothing();
      const double root = std::sqrt(inside);
      first = std::max(first, (-slope - root) / least), last = std::min(last, (-slope + root) / least);
      if (first > last) return nothing();
    }
    const double off = (g + turn * std::max(-first, last)) / min_length_;
    RootBox out;
    set(out, by_u_ ? 1 : 0, 0.5 + first, 0.5 + last);
    set(out, by_u_ ? 0 : 1, p0 + std::min(-s * first, -s * last) - off, p0 + std::max(-s * first, -s * last) + off);
    return out;
  }

 private:
  /// Second derivatives of h.
  struct Bends {
    Hull pp, pq, qq;
  };

  static double squared(const Hull& a, const Hull& b) { return a.centre() * a.centre() + b.centre() * b.centre(); }
  static RootBox nothing() { return {{1, 1}, {0, 0}}; }

  static Hull sum(const Hull& a, double factor, const Hull& b) {
    return {a.low + factor * (factor < 0 ? b.high : b.low), a.high + factor * (factor < 0 ? b.low : b.high)};
  }

  /// Returns the largest |g_q - s g_p|.
  double turn_of(double s) const {
    const Hull &xp = by_u_ ? x_.u : x_.v, &yp = by_u_ ? y_.u : y_.v, &xq = by_u_ ? x_.v : x_.u,
               &yq = by_u_ ? y_.v : y_.u;
    const Hull x = sum(xq, -s, xp), y = sum(yq, -s, yp);
    return std::abs(a_ * x.centre() + b_ * y.centre()) + std::abs(a_) * x.radius() + std::abs(b_) * y.radius() +
           (1 + std::abs(s)) * slope_noise_;
  }

  /// Sets a side of the box, widened by rounding.
  static void set(RootBox& out, int side, double first, double last) {
    constexpr double epsilon = 64 * std::numeric_limits<double>::epsilon();
    out.low[side] = std::max(0.0, first - epsilon * (1 + std::abs(first)));
    out.high[side] = std::min(1.0, last + epsilon * (1 + std::abs(last)));
  }

  /// Bounds second derivatives by differences of coefficients (Farin, Curves and Surfaces for CAGD, 5th ed., eqs. 5.24
  /// and 14.11).
  template <class Shape>
  Bends bends_of(const Shape& shape, const double* net) const {
    const int size = shape.size(), columns = shape.columns();
    std::array<double, (max_degree + 1) * (max_degree + 1)> h;
    for (int k = 0; k < size; ++k) h[static_cast<std::size_t>(k)] = a_ * net[size + k] - b_ * net[k];
    const int m = by_u_ ? shape.m() : shape.n(), n = by_u_ ? shape.n() : shape.m();
    const int along_p = by_u_ ? columns : 1, along_q = by_u_ ? 1 : columns;
    const auto at = [&](int i, int j) { return h[static_cast<std::size_t>(i * along_p + j * along_q)]; };
    Bends out{m < 2 ? Hull{0, 0} : Hull{}, {}, n < 2 ? Hull{0, 0} : Hull{}};
    for (int i = 0; i <= m; ++i) {
      for (int j = 0; j <= n; ++j) {
        if (i > 1) out.pp.extend(m * (m - 1) * (at(i, j) - 2 * at(i - 1, j) + at(i - 2, j)));
        if (j > 1) out.qq.extend(n * (n - 1) * (at(i, j) - 2 * at(i, j - 1) + at(i, j - 2)));
        if (i > 0 && j > 0) out.pq.extend(m * n * (at(i, j) - at(i - 1, j) - at(i, j - 1) + at(i - 1, j - 1)));
      }
    }
    return out;
  }

  const DerivativeHulls &x_, &y_;
  double noise_, slope_noise_, bend_noise_;
  bool by_u_ = true;
  double a_ = 0, b_ = 0;
  double length_ = 0, min_length_ = 0;  ///< of g_p: mean, lower bound
};

}}  // namespace tessera::abi_0_1
