#pragma once
// The protocols between grid_sisl.cpp and the program sisl_grid, ray_sisl.cpp and sisl_rays, nearest_sisl.cpp and
// sisl_points, over standard input and output. Numbers are in the machine's own format.

#include <cstdint>

/// Sent to sisl_grid: this, its control points [i][j][component] and its parameters, doubles; then commands, a byte
/// each:
///   'r'  runs s1506 once: the answer is a double, the seconds of processor time it took
///   'v'  and two std::uint64_t, the parameters' numbers i and j: the answer is 9 doubles, position, r_u, r_v
struct SislTask {
  std::int32_t side = 0;      ///< control points in each direction
  std::int32_t count = 0;     ///< parameters in each direction
  std::int32_t tangents = 0;  ///< 1: r_u and r_v too
};

/// Sent to sisl_rays: this, its control points as above and its rays, origin and direction, 6 doubles each; then
/// commands:
///   'r'  casts all rays: the answer is the seconds of processor time, and t of each ray's nearest hit
struct SislRayTask {
  std::int32_t side = 0;
  std::int32_t rays = 0;
  double tolerance = 0;  ///< of s1856, a length
};

/// Sent to sisl_points: this, its control points as above and its points, 3 doubles each; then commands:
///   'r'  searches from all points: the answer is the seconds of processor time, and the distance of each
struct SislPointTask {
  std::int32_t side = 0;
  std::int32_t points = 0;
  double tolerance = 0;  ///< of s1958, a length
};
