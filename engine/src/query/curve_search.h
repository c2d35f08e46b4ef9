#pragma once
// The nearest point of one curve by bounds of its second derivative.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

#include "base/infinity.h"
#include "query/kept_curve.h"
#include "query/nearest_foot.h"
#include "query/query_tree.h"
#include "query/range.h"
#include "tessera/geometry.h"

namespace tessera { inline namespace abi_0_1 {

/// Bounds one coordinate of a rational curve by its homogeneous control values over the part, x w and w.
inline void bound_coordinate(std::span<const double> x, std::span<const double> w, Range& value, Range& first,
                             Range& second) {
  const std::size_t n = x.size() - 1;
  const double scale = double(n);
  Range weight, dw{0, 0}, ddw{0, 0}, dx, ddx{0, 0};
  for (std::size_t k = 0; k <= n; ++k) value.extend(x[k] / w[k]), weight.extend(w[k]);
  if (n > 0) dw = dx = {};
  for (std::size_t k = 0; k < n; ++k) dx.extend(scale * (x[k + 1] - x[k])), dw.extend(scale * (w[k + 1] - w[k]));
  if (n > 1) ddw = ddx = {};
  for (std::size_t k = 0; k + 1 < n; ++k) {
    ddx.extend(scale * (scale - 1) * (x[k + 2] - 2 * x[k + 1] + x[k]));
    ddw.extend(scale * (scale - 1) * (w[k + 2] - 2 * w[k + 1] + w[k]));
  }
  first = divided(dx + (-1.0 * dw) * value, weight);
  second = divided(ddx + (-2.0 * dw) * first + (-1.0 * ddw) * value, weight);
}

/// Returns boxes of a curve by its ends and how far it may be from its chord.
inline ItemBoxes chord_boxes(const Vec3& a, const Vec3& b, double sag) {
  const double reach = sag + 1e-14;
  Box3 box;
  box.extend(a), box.extend(b);
  box.lower += Vec3{-reach, -reach, -reach}, box.upper += Vec3{reach, reach, reach};
  const Vec3 x = a == b ? Vec3{1, 0, 0} : normalized(b - a);
  const Vec3 y = normalized(cross(x, std::abs(x.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}));
  return {box, {0.5 * (a + b), {x, y, cross(x, y)}, {0.5 * length(b - a) + reach, reach, reach}}};
}

inline double chord_distance(const Vec3& a, const Vec3& b, const Vec3& point) {
  const Vec3 along = b - a, from = point - a;
  const double square = dot(along, along);
  const double share = square > 0 ? std::clamp(dot(from, along) / square, 0.0, 1.0) : 0;
  return length(from - share * along);
}

/// The search of one curve: parts of its parameter, halved until each is decided. At: t -> CurvePoint.
template <class At>
class CurveSearch {
 public:
  /// `bend`: the second derivative by t. `scale`: from lengths to shares of the size. `limit`: the distance beyond
  /// which points are of no use.
  CurveSearch(const At& at, const VectorRange& bend, double scale, const Vec3& point, double limit)
      : at_(at), bend_(bend), scale_(scale), point_(point), limit_(limit) {
    best_.distance = infinity, best_.converged = true, best_.is_farther = true, best_.on_border = true;
  }

  /// `parts` counts the work; when it reaches `max_parts` the search ends, and the foot is not converged.
  Foot run(double from, double to, int max_parts, int& parts) {
    struct Part {
      double from, to;
      CurvePoint first, last;
    };
    Part stack[max_depth];
    int count = 0;
    stack[count++] = {from, to, at(from), at(to)};
    while (count > 0) {
      const Part part = stack[--count];
      ++parts;
      if (is_decided(part.from, part.to, part.first, part.last)) continue;
      const double middle = 0.5 * (part.from + part.to);
      if (parts >= max_parts || count + 2 > max_depth || !(part.from < middle && middle < part.to)) {
        best_.converged = false;
        continue;
      }
      const CurvePoint between = at(middle);
      const bool is_first_nearer = length(part.first.position - point_) <= length(part.last.position - point_);
      const Part lower{part.from, middle, part.first, between}, upper{middle, part.to, between, part.last};
      stack[count++] = is_first_nearer ? upper : lower;
      stack[count++] = is_first_nearer ? lower : upper;
    }
    return best_;
  }

 private:
  static constexpr int max_depth = 64;

  CurvePoint at(double t) {
    const CurvePoint point = at_(t);
    const double distance = length(point.position - point_);
    if (distance < best_.distance)
      best_.u = point.u, best_.v = point.v, best_.position = point.position, best_.distance = distance;
    if (distance <= limit_) best_.is_farther = false;
    return point;
  }

  /// Decides a part: it is too far, the distance is monotone over it, or convex.
  bool is_decided(double from, double to, const CurvePoint& first, const CurvePoint& last) {
    const double span = to - from;
    const double bend = bend_.magnitude(), sag = 0.125 * bend * span * span;
    const double chord = chord_distance(first.position, last.position, point_);
    const double most = std::min(limit_, best_.distance);
    // No nearer than what is known, up to rounding.
    if (chord - sag > limit_ || chord - sag >= most * (1 - 1e-15) - rounding / scale_) return true;
    const Vec3 r = first.position - point_, q = last.position - point_;
    const double radius = length(last.position - first.position) + sag;
    const double least = std::max(length(last.position - first.position) / span - bend * span, 0.0);
    const double convex = least * least + std::max(bend_.along(r).lower, bend_.along(q).lower) - radius * bend;
    if (!(convex > 0)) return false;
    find_root(from, to, dot(r, first.derivative), dot(q, last.derivative));
    return true;
  }

  /// Finds the root of the increasing derivative of the distance, by false position with the Illinois rule.
  void find_root(double from, double to, double low, double high) {
    if (low >= 0 || high <= 0) return;  // an end is the nearest point, and known
    int side = 0;
    for (int k = 0; k < 60 && to - from > 1e-16; ++k) {
      const double t = std::clamp(from - low * (to - from) / (high - low), from, to);
      const CurvePoint point = at(t);
      const double value = dot(point.position - point_, point.derivative);
      if (std::abs(value) <= 4e-16 * length(point.derivative) * (1 / scale_)) return;
      if (value < 0) {
        if (side < 0) high *= 0.5;
        from = t, low = value, side = -1;
      } else {
        if (side > 0) low *= 0.5;
        to = t, high = value, side = 1;
      }
    }
  }

  static constexpr double rounding = 4e-15;  // in the scene's coordinates
  const At& at_;
  const VectorRange bend_;
  const double scale_;
  const Vec3 point_;
  const double limit_;
  Foot best_{};
};

}}  // namespace tessera::abi_0_1
