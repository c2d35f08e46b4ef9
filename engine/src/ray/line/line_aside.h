#pragma once
// Lines beside a line that passes an edge, for all its hits.

#include <cmath>
#include <cstddef>
#include <numbers>

#include "ray/line/ray_line.h"

namespace tessera::inline abi_0_1 {

inline constexpr std::size_t ways_aside = 8;  ///< directions in which a line is moved
inline constexpr double far_aside = 2.5;      ///< how far, as a multiple of the edge's gap: out of its tube

/// Returns the line moved in one of these ways. `box`: of the scene, in its own coordinates.
inline RayLine line_aside(const RayLine& line, std::size_t way, double gap, const Box3& box) {
  const double angle = 2 * std::numbers::pi * static_cast<double>(way) / ways_aside;
  return moved(line, far_aside * gap * (std::cos(angle) * line.across[0] + std::sin(angle) * line.across[1]), box);
}

}  // namespace tessera::inline abi_0_1
