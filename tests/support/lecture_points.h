#pragma once
// The bicubic net of the lectures that the surfaces come from; tests require their figures to the last printed digit.

#include <vector>

#include "tessera/geometry.h"

namespace tessera::test {

/// The sixteen points of the lectures: entry [row][column] is V_{column,row}.
inline std::vector<Vec3> lecture_points() {
  constexpr double x[4][4] = {{0, 1, 1, 1}, {0, 1, 1, -1}, {-1, 1, 0, 0}, {1, 1, 0, 0}};
  constexpr double y[4][4] = {{0, 0, 1, 1}, {1, 1, 1, 1}, {1, 1, 0, 0}, {1, 1, 0, 0}};
  constexpr double z[4][4] = {{2, -1, 1, 1}, {3, -2, 1, -1}, {-1, 1, 0, 0}, {1, 1, 0, 0}};
  std::vector<Vec3> points;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) points.push_back({x[j][i], y[j][i], z[j][i]});
  return points;
}

}  // namespace tessera::test
