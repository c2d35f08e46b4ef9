#pragma once
// How grid_sisl.cpp talks to the program sisl_grid, over its standard input and output, in the machine's own numbers.
// First a SislTask, then its control points [i][j][component] and its parameters, doubles; then commands, a byte each:
//   'r'  runs s1506 once: the answer is a double, the seconds of processor time it took
//   'v'  and two std::uint64_t, the parameters' numbers i and j: the answer is 9 doubles, position, r_u, r_v

#include <cstdint>

struct SislTask {
  std::int32_t side = 0;      ///< control points each way
  std::int32_t count = 0;     ///< parameters each way
  std::int32_t tangents = 0;  ///< 1: r_u and r_v as well
};
