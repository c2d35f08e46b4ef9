#include "query/kept_curve.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "query/curve_search.h"
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
  return chord_boxes(position_of(ground, curve, curve.from), position_of(ground, curve, curve.to), sag_of(curve));
}

Foot nearest_foot(const CurveGround& ground, const KeptCurve& curve, const Vec3& point, double limit, int max_parts,
                  int& parts) {
  const auto at = [&](double t) { return point_of(ground, curve, t); };
  return CurveSearch(at, (1 / ground.frame->scale) * curve.bend, ground.frame->scale, point, limit)
      .run(curve.from, curve.to, max_parts, parts);
}

}}  // namespace tessera::abi_0_1
