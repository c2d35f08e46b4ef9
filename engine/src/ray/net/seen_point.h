#pragma once
// Projects a point of a patch and its derivatives into a ray's frame.

#include "ray/line/first_order.h"
#include "ray/line/ray_line.h"
#include "ray/net/projected_net.h"

namespace tessera { inline namespace abi_0_1 {

/// Both are in the scene's coordinates.
inline NetValue seen(const FirstOrder& at, const RayLine& line) {
  const Vec3 from = at.position - line.start;
  NetValue f;
  f.x = dot(line.across[0], from), f.y = dot(line.across[1], from), f.z = dot(line.direction, from);
  f.xu = dot(line.across[0], at.du), f.xv = dot(line.across[0], at.dv);
  f.yu = dot(line.across[1], at.du), f.yv = dot(line.across[1], at.dv);
  return f;
}

}}  // namespace tessera::abi_0_1
