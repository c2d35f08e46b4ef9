#pragma once
// The axis of a model that points up.

#include <cstdint>

#include "tessera/geometry.h"

namespace tessera::render {

enum class Up : std::uint8_t { x, y, z };

/// Turns coordinates cyclically, so that `up` becomes z.
inline Vec3 to_z_up(const Vec3& v, Up up) {
  if (up == Up::x) return {v.y, v.z, v.x};
  return up == Up::y ? Vec3{v.z, v.x, v.y} : v;
}

/// The inverse of to_z_up().
inline Vec3 from_z_up(const Vec3& v, Up up) {
  if (up == Up::x) return {v.z, v.x, v.y};
  return up == Up::y ? Vec3{v.y, v.z, v.x} : v;
}

}  // namespace tessera::render
