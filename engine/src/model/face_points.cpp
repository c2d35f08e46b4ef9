#include "model/face_points.h"

#include <algorithm>
#include <cmath>

namespace tessera { inline namespace abi_0_1 {
namespace {

/// The parameter within [from, to] that is whole periods away.
double wrapped(double value, double from, double to) {
  const double period = to - from, turns = std::floor((value - from) / period);
  return std::clamp(value - turns * period, from, to);
}

/// The place of a loop's point in the face's domain.
Result<Vec3> in_domain(const ModelSurface& face, Vec3 uv) {
  const Domain d = domain(face.surface);
  const auto closed = [&](const Vec3& a, const Vec3& middle, const Vec3& b) -> Result<bool> {
    const Result<SurfaceJet> at_a = evaluate_jet(face, a.x, a.y), at_middle = evaluate_jet(face, middle.x, middle.y),
                             at_b = evaluate_jet(face, b.x, b.y);
    for (const auto* const jet : {&at_a, &at_middle, &at_b})
      if (!*jet) return jet->status();
    return length(at_a->position - at_b->position) <= 1e-6 * length(at_a->position - at_middle->position);
  };
  const double far_u = 1e-9 * (d.u1 - d.u0), far_v = 1e-9 * (d.v1 - d.v0);
  if (uv.x < d.u0 - far_u || uv.x > d.u1 + far_u) {
    const double v = std::clamp(uv.y, d.v0, d.v1);
    const Result<bool> around = closed({d.u0, v, 0}, {d.u_at(0.5), v, 0}, {d.u1, v, 0});
    if (!around) return around.status();
    if (*around) uv.x = wrapped(uv.x, d.u0, d.u1);
  }
  if (uv.y < d.v0 - far_v || uv.y > d.v1 + far_v) {
    const double u = std::clamp(uv.x, d.u0, d.u1);
    const Result<bool> around = closed({u, d.v0, 0}, {u, d.v_at(0.5), 0}, {u, d.v1, 0});
    if (!around) return around.status();
    if (*around) uv.y = wrapped(uv.y, d.v0, d.v1);
  }
  return uv;
}

}  // namespace

Result<FacePoint> face_point(const ModelSurface& face, const Curve& curve, double t) {
  const CurveJet plane = evaluate_jet(curve, t);
  const Result<Vec3> uv = in_domain(face, plane.position);
  if (!uv) return uv.status();
  const Result<SurfaceJet> jet = evaluate_jet(face, uv->x, uv->y);
  if (!jet) return jet.status();
  return FacePoint{jet->position, plane.first.x * jet->du + plane.first.y * jet->dv};
}

}}  // namespace tessera::abi_0_1
