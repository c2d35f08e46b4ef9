#pragma once
// Two unit vectors across a direction, for projections along a ray.

#include <cmath>

#include "tessera/geometry.h"

namespace tessera { inline namespace abi_0_1 {

/// Two unit vectors that make an orthonormal basis with the unit vector d (Duff et al., Building an orthonormal basis,
/// revisited, JCGT 6(1), 2017).
struct OrthonormalBasis {
  Vec3 first, second;

  explicit OrthonormalBasis(const Vec3& d) {
    const double sign = std::copysign(1.0, d.z), a = -1 / (sign + d.z), b = d.x * d.y * a;
    first = {1 + sign * d.x * d.x * a, sign * b, -sign * d.x};
    second = {b, sign + d.y * d.y * a, -d.y};
  }
};

}}  // namespace tessera::abi_0_1
