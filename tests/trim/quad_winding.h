#pragma once
// A checker that shares no code with the library: crossings of loops in 128-bit floating point.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "tessera/trim_loop.h"

namespace tessera::test {

#ifdef __SIZEOF_FLOAT128__
__extension__ using Quad = __float128;
#else
using Quad = long double;  // 128 bits on 64-bit ARM
#endif

/// A control point times its weight, and the weight.
struct QuadPoint {
  Quad u = 0, v = 0, w = 1;
};
inline QuadPoint mix(const QuadPoint& a, const QuadPoint& b, Quad t) {
  return {a.u + t * (b.u - a.u), a.v + t * (b.v - a.v), a.w + t * (b.w - a.w)};
}

/// A Bezier curve over [from, to] of the parameters of its curve.
struct QuadBezier {
  std::vector<QuadPoint> points;
  double from = 0, to = 1;

  /// C(t) for t in [0, 1], by de Casteljau's algorithm, projected.
  QuadPoint at(Quad t) const {
    std::vector<QuadPoint> p = points;
    for (std::size_t last = p.size() - 1; last > 0; --last)
      for (std::size_t i = 0; i < last; ++i) p[i] = mix(p[i], p[i + 1], t);
    return {p[0].u / p[0].w, p[0].v / p[0].w, 1};
  }
};

/// The blossom of one span of a curve at `arguments` (de Boor, homogeneous).
inline QuadPoint blossom(const Curve& curve, std::size_t span, const std::vector<double>& arguments) {
  const auto p = static_cast<std::size_t>(curve.degree());
  std::vector<QuadPoint> d;
  for (std::size_t i = span - p; i <= span; ++i) {
    const Quad w = curve.weight(i);
    d.push_back({curve.points()[i].x * w, curve.points()[i].y * w, w});
  }
  for (std::size_t level = 1; level <= p; ++level)
    for (std::size_t i = 0; i + level <= p; ++i) {
      const Quad left = curve.knots()[span - p + i + level], right = curve.knots()[span + 1 + i];
      d[i] = mix(d[i], d[i + 1], (arguments[level - 1] - left) / (right - left));
    }
  return d[0];
}

/// All Bezier curves of the loops.
inline std::vector<QuadBezier> quad_beziers(std::span<const TrimLoop> loops) {
  std::vector<QuadBezier> all;
  for (const TrimLoop& loop : loops)
    for (const Curve& curve : loop.curves)
      for (std::size_t span = 0; span + 1 < curve.knots().size(); ++span) {
        const double from = std::max(curve.knots()[span], curve.domain().from);
        const double to = std::min(curve.knots()[span + 1], curve.domain().to);
        if (!(from < to)) continue;
        const auto p = static_cast<std::size_t>(curve.degree());
        QuadBezier bezier{{}, from, to};
        for (std::size_t i = 0; i <= p; ++i) {
          std::vector<double> arguments(p, from);
          std::fill(arguments.begin(), arguments.begin() + static_cast<std::ptrdiff_t>(i), to);
          bezier.points.push_back(blossom(curve, span, arguments));
        }
        all.push_back(std::move(bezier));
      }
  return all;
}

/// How often a ray from q towards larger u crosses the curve, modulo 2, heights half-open. Nothing if that takes a part
/// of the curve shorter than `least`.
inline std::optional<bool> crosses(std::span<const QuadPoint> points, Quad u, Quad v, Quad least) {
  Quad u0 = points[0].u / points[0].w, u1 = u0, v0 = points[0].v / points[0].w, v1 = v0;
  for (const QuadPoint& p : points) {
    u0 = std::min(u0, p.u / p.w), u1 = std::max(u1, p.u / p.w);
    v0 = std::min(v0, p.v / p.w), v1 = std::max(v1, p.v / p.w);
  }
  if (v0 > v || v1 <= v || u1 < u) return false;
  if (u0 > u) return (points.front().v / points.front().w > v) != (points.back().v / points.back().w > v);
  if (u1 - u0 < least && v1 - v0 < least) return {};
  std::vector<QuadPoint> left(points.begin(), points.end()), right = left;
  for (std::size_t level = 1; level < points.size(); ++level) {
    for (std::size_t i = 0; i + level < points.size(); ++i) right[i] = mix(right[i], right[i + 1], Quad(0.5));
    left[level] = right[0];
  }
  const std::optional<bool> a = crosses(left, u, v, least);
  if (!a) return {};
  const std::optional<bool> b = crosses(right, u, v, least);
  if (!b) return {};
  return *a != *b;
}

/// Whether the curve passes through the box around q, up to 1e-25.
inline bool passes(std::span<const QuadPoint> points, Quad u, Quad v, Quad half_u, Quad half_v) {
  Quad u0 = points[0].u / points[0].w, u1 = u0, v0 = points[0].v / points[0].w, v1 = v0;
  for (const QuadPoint& p : points) {
    u0 = std::min(u0, p.u / p.w), u1 = std::max(u1, p.u / p.w);
    v0 = std::min(v0, p.v / p.w), v1 = std::max(v1, p.v / p.w);
  }
  if (u0 > u + half_u || u1 < u - half_u || v0 > v + half_v || v1 < v - half_v) return false;
  const bool within = u0 >= u - half_u && u1 <= u + half_u && v0 >= v - half_v && v1 <= v + half_v;
  if (within || (u1 - u0 < Quad(1e-25) && v1 - v0 < Quad(1e-25))) return true;
  std::vector<QuadPoint> left(points.begin(), points.end()), right = left;
  for (std::size_t level = 1; level < points.size(); ++level) {
    for (std::size_t i = 0; i + level < points.size(); ++i) right[i] = mix(right[i], right[i + 1], Quad(0.5));
    left[level] = right[0];
  }
  return passes(left, u, v, half_u, half_v) || passes(right, u, v, half_u, half_v);
}

/// Whether an odd number of the loops that are made of these curves enclose a point; nothing if it lies on
/// one of them.
inline std::optional<bool> encloses(std::span<const QuadBezier> curves, double u, double v, double least = 1e-29) {
  bool parity = false;
  for (const QuadBezier& curve : curves) {
    const std::optional<bool> crossing = crosses(curve.points, u, v, least);
    if (!crossing) return {};
    parity ^= *crossing;
  }
  return parity;
}

}  // namespace tessera::test
