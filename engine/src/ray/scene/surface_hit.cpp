#include "ray/scene/surface_hit.h"

#include <algorithm>
#include <cmath>

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Sets the normal of unit_normal, from the given derivatives if these are clearly regular.
void set_normal(const BezierPatch& patch, double size, double u, double v, const FirstOrder& at, Hit& hit) {
  constexpr double clearly = 1e-6;
  const Vec3 normal = cross(at.du, at.dv);
  const double du = dot(at.du, at.du), dv = dot(at.dv, at.dv), area = dot(normal, normal);
  if (std::min(du, dv) > clearly * clearly * (size * size) && area > clearly * clearly * (du * dv)) {
    hit.normal = (1 / std::sqrt(area)) * normal;
    return;
  }
  const UnitNormal limit = unit_normal(patch, u, v);
  hit.normal = limit.direction;
  hit.flags.degenerate_normal = limit.kind != NormalKind::regular;
}

}  // namespace

void set_surface_point(const SetView& set, double size, double unit, std::uint32_t patch, double u, double v,
                       const FirstOrder& at, Hit& hit, HitParts parts) {
  const Domain& domain = set_place(set, patch, u, v, hit);
  if (parts.point) hit.position = at.position;
  if (parts.derivatives) {
    hit.du = (unit / (domain.u1 - domain.u0)) * at.du;
    hit.dv = (unit / (domain.v1 - domain.v0)) * at.dv;
  }
  if (parts.normal) set_normal(set.patch(patch), size, u, v, at, hit);
}

}}  // namespace tessera::abi_0_1
