#pragma once
// Lengths whose squares leave the range of doubles.

#include <cmath>

#include "tessera/geometry.h"

namespace tessera { inline namespace abi_0_1 {

/// |a| without over- or underflow on the way.
inline double safe_length(const Vec3& a) {
  const double largest = max_abs(a);
  if (!(largest > 0) || !std::isfinite(largest)) return largest;
  return largest * length({a.x / largest, a.y / largest, a.z / largest});
}

}}  // namespace tessera::abi_0_1
