#pragma once
// Finds the edges of a control net that are a single point.

#include <span>

#include "tessera/geometry.h"

namespace tessera { inline namespace abi_0_1 {

/// Returns the edges whose control points, `[i][j]`, all coincide by ==.
inline SideMask collapsed_sides(int degree_u, int degree_v, std::span<const Vec3> points) {
  const int m = degree_u, n = degree_v;
  const auto point = [&](int i, int j) -> const Vec3& { return points[static_cast<std::size_t>(i * (n + 1) + j)]; };
  const auto coincide = [&](int i, int j, int step_i, int step_j, int steps) {
    for (int k = 1; k <= steps; ++k)
      if (point(i + k * step_i, j + k * step_j) != point(i, j)) return false;
    return true;
  };
  SideMask edges;
  if (coincide(0, 0, 0, 1, n)) edges.add(Side::u0);
  if (coincide(m, 0, 0, 1, n)) edges.add(Side::u1);
  if (coincide(0, 0, 1, 0, m)) edges.add(Side::v0);
  if (coincide(0, n, 1, 0, m)) edges.add(Side::v1);
  return edges;
}

}}  // namespace tessera::abi_0_1
