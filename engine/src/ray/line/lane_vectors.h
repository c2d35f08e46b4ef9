#pragma once
// Access to the vectors of several rays, `[coordinate][ray]`, as in the kernels.

#include <cstddef>

#include "tessera/geometry.h"

namespace tessera { inline namespace abi_0_1 {

template <std::size_t Size>
void put(const Vec3& v, double (&to)[3][Size], std::size_t k) {
  to[0][k] = v.x, to[1][k] = v.y, to[2][k] = v.z;
}
template <std::size_t Size>
Vec3 get(const double (&from)[3][Size], std::size_t k) {
  return {from[0][k], from[1][k], from[2][k]};
}

}}  // namespace tessera::abi_0_1
