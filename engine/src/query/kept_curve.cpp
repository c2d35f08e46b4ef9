#include "query/kept_curve.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "query/net_parts.h"
#include "ray/line/first_order.h"
#include "ray/net/projected_net.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// A plane curve's point and its derivative by t, in a patch's parameters.
struct PlanePoint {
  ParameterPoint at, by_t;
};

PlanePoint plane_point(const PlaneBezier& curve, const Domain& domain, double t) {
  const NetBasis<0> basis(curve.degree(), t);
  double u = 0, v = 0, w = 0, du = 0, dv = 0, dw = 0;
  for (std::size_t k = 0; k < curve.points.size(); ++k) {
    const double weight = curve.weight(k), x = domain.local_u(curve.points[k].u), y = domain.local_v(curve.points[k].v);
    const double b = basis.value[k] * weight, d = basis.derivative[k] * weight;
    u += b * x, v += b * y, w += b, du += d * x, dv += d * y, dw += d;
  }
  const ParameterPoint at{u / w, v / w};
  return {{std::clamp(at.u, 0.0, 1.0), std::clamp(at.v, 0.0, 1.0)}, {(du - dw * at.u) / w, (dv - dw * at.v) / w}};
}

/// The ranges of a plane curve over a part of it, and of its derivatives, in a patch's parameters.
struct PlaneRanges {
  Range u, v, du, dv, duu, dvv;
};

/// Bounds one coordinate of a rational curve by its homogeneous control values over the part, x w and w.
void bound_coordinate(std::span<const double> x, std::span<const double> w, Range& value, Range& first, Range& second) {
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

PlaneRanges plane_ranges(const PlaneBezier& curve, const Domain& domain, double from, double to) {
  constexpr std::size_t most = max_degree + 1;
  std::array<double, most> u, v, w;
  const std::size_t count = curve.points.size();
  const ParameterPoint middle = plane_point(curve, domain, 0.5 * (from + to)).at;  // keeps differences small
  for (std::size_t k = 0; k < count; ++k) {
    w[k] = curve.weight(k);
    u[k] = w[k] * (domain.local_u(curve.points[k].u) - middle.u);
    v[k] = w[k] * (domain.local_v(curve.points[k].v) - middle.v);
  }
  for (double* line : {u.data(), v.data(), w.data()}) restrict_line(curve.degree(), line, 1, from, to);
  PlaneRanges out;
  bound_coordinate({u.data(), count}, {w.data(), count}, out.u, out.du, out.duu);
  bound_coordinate({v.data(), count}, {w.data(), count}, out.v, out.dv, out.dvv);
  const double share = 1 / (to - from);
  out.du = share * out.du, out.dv = share * out.dv;
  out.duu = share * share * out.duu, out.dvv = share * share * out.dvv;
  constexpr double margin = 1e-12;
  out.u = (out.u + Range{middle.u, middle.u}).widened(margin),
  out.v = (out.v + Range{middle.v, middle.v}).widened(margin);
  return out;
}

/// A range of parameters within [0, 1], not empty and not a point.
Range within_patch(const Range& range) {
  constexpr double least = 1e-9;
  Range out{std::clamp(range.lower, 0.0, 1 - least), std::clamp(range.upper, 0.0, 1.0)};
  out.upper = std::max(out.upper, out.lower + least);
  return out;
}

Vec3 position_of(const CurveGround& ground, const KeptCurve& curve, double t) {
  return ground.frame->scale * point_of(ground, curve, t).position;
}

double chord_distance(const Vec3& a, const Vec3& b, const Vec3& point) {
  const Vec3 along = b - a, from = point - a;
  const double square = dot(along, along);
  const double share = square > 0 ? std::clamp(dot(from, along) / square, 0.0, 1.0) : 0;
  return length(from - share * along);
}

/// The search of one curve: parts of its parameter, halved until each is decided.
class CurveSearch {
 public:
  CurveSearch(const CurveGround& ground, const KeptCurve& curve, const Vec3& point, double limit)
      : ground_(ground), curve_(curve), point_(point), limit_(limit) {
    best_.distance = infinity, best_.converged = true, best_.is_farther = true, best_.on_border = true;
  }

  Foot run(int max_parts, int& parts) {
    struct Part {
      double from, to;
      CurvePoint first, last;
    };
    Part stack[max_depth];
    int count = 0;
    stack[count++] = {curve_.from, curve_.to, at(curve_.from), at(curve_.to)};
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
    const CurvePoint point = point_of(ground_, curve_, t);
    const double distance = length(point.position - point_);
    if (distance < best_.distance)
      best_.u = point.u, best_.v = point.v, best_.position = point.position, best_.distance = distance;
    if (distance <= limit_) best_.is_farther = false;
    return point;
  }

  /// Decides a part: it is too far, the distance is monotone over it, or convex.
  bool is_decided(double from, double to, const CurvePoint& first, const CurvePoint& last) {
    const double span = to - from, scale = ground_.frame->scale;
    const double bend = curve_.bend.magnitude() / scale, sag = 0.125 * bend * span * span;
    const double chord = chord_distance(first.position, last.position, point_);
    const double most = std::min(limit_, best_.distance);
    // No nearer than what is known, up to rounding.
    if (chord - sag > limit_ || chord - sag >= most * (1 - 1e-15) - rounding / scale) return true;
    const Vec3 r = first.position - point_, q = last.position - point_;
    const double radius = length(last.position - first.position) + sag;
    const VectorRange second = (1 / scale) * curve_.bend;
    const double least = std::max(length(last.position - first.position) / span - bend * span, 0.0);
    const double convex = least * least + std::max(second.along(r).lower, second.along(q).lower) - radius * bend;
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
      if (std::abs(value) <= 4e-16 * length(point.derivative) * (1 / ground_.frame->scale)) return;
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
  const CurveGround& ground_;
  const KeptCurve& curve_;
  const Vec3 point_;
  const double limit_;
  Foot best_{};
};

}  // namespace

CurvePoint point_of(const CurveGround& ground, const KeptCurve& curve, double t) {
  const PlanePoint at = plane_point(curve.piece->curve, *ground.domain, t);
  const FirstOrder point = first_order(*ground.patch, ground.frame->centre, *ground.kernels, at.at.u, at.at.v);
  return {at.at.u, at.at.v, point.position, at.by_t.u * point.du + at.by_t.v * point.dv};
}

/// The second derivative is s_u u'' + s_v v'' + s_uu u'^2 + 2 s_uv u' v' + s_vv v'^2.
void bound_bend(const CurveGround& ground, KeptCurve& curve) {
  const PlaneRanges plane = plane_ranges(curve.piece->curve, *ground.domain, curve.from, curve.to);
  const Range u = within_patch(plane.u), v = within_patch(plane.v);
  NetParts nets(*ground.patch, *ground.frame);
  const DerivativeRanges d = derivative_ranges(nets.part({u.lower, u.upper, v.lower, v.upper}));
  const double by_u = 1 / (u.upper - u.lower), by_v = 1 / (v.upper - v.lower);
  curve.bend = (by_u * plane.duu) * d.du + (by_v * plane.dvv) * d.dv + (by_u * by_u * (plane.du * plane.du)) * d.duu +
               (2 * by_u * by_v * (plane.du * plane.dv)) * d.duv + (by_v * by_v * (plane.dv * plane.dv)) * d.dvv;
}

double sag_of(const KeptCurve& curve) {
  return 0.125 * curve.bend.magnitude() * (curve.to - curve.from) * (curve.to - curve.from);
}

ItemBoxes boxes_of(const CurveGround& ground, const KeptCurve& curve) {
  const Vec3 a = position_of(ground, curve, curve.from), b = position_of(ground, curve, curve.to);
  const double reach = sag_of(curve) + 1e-14;
  Box3 box;
  box.extend(a), box.extend(b);
  box.lower += Vec3{-reach, -reach, -reach}, box.upper += Vec3{reach, reach, reach};
  const Vec3 x = a == b ? Vec3{1, 0, 0} : normalized(b - a);
  const Vec3 y = normalized(cross(x, std::abs(x.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}));
  return {box, {0.5 * (a + b), {x, y, cross(x, y)}, {0.5 * length(b - a) + reach, reach, reach}}};
}

Foot nearest_foot(const CurveGround& ground, const KeptCurve& curve, const Vec3& point, double limit, int max_parts,
                  int& parts) {
  return CurveSearch(ground, curve, point, limit).run(max_parts, parts);
}

}}  // namespace tessera::abi_0_1
