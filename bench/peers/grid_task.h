#pragma once
// The work by which programs are compared: a bicubic B-spline surface over uniform knots, spans x spans of them, at
// per_span x per_span points each; positions or positions + r_u + r_v, one thread.

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "tessera/geometry.h"

namespace tessera::bench {

struct GridTask {
  int spans = 0, per_span = 0;
  bool tangents = false;
  std::vector<Vec3> net;      ///< [i][j], side() x side() control points
  std::vector<double> local;  ///< parameters of points within a span, inside (0, 1), for all spans and both directions

  int side() const { return spans + 3; }
  std::size_t count() const {
    return static_cast<std::size_t>(spans) * static_cast<std::size_t>(per_span);
  }  ///< in each direction
  std::size_t points() const { return count() * count(); }
  /// Parameter k of all, in [0, spans].
  double parameter(std::size_t k) const {
    const auto n = static_cast<std::size_t>(per_span);
    return static_cast<double>(k / n) + local[k % n];
  }
  std::size_t components() const { return tangents ? 9 : 3; }
};

/// Values at one point; derivatives are by parameters that run over 1 in a span.
struct GridValue {
  Vec3 position, du, dv;
};

/// One way in which a program does the task.
struct GridRun {
  std::string program, way;
  bool in_double = false;
  std::function<double()> seconds;  ///< does the task once; returns its processor time
  std::function<GridValue(std::size_t i, std::size_t j)>
      read;  ///< result of the last time, at parameters i of u, j of v
};

/// A program that was found: its runs for a task, which must outlive them. Each peer's source holds one.
struct GridPeer {
  std::string name;
  std::function<std::vector<GridRun>(const GridTask&)> runs;
};
inline std::vector<GridPeer>& grid_peers() {
  static std::vector<GridPeer> peers;
  return peers;
}

}  // namespace tessera::bench
