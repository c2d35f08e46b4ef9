#pragma once
// The work by which searches of nearest points are compared: points near a bicubic B-spline surface over uniform knots,
// or anywhere in its box, one thread.

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "tessera/geometry.h"

namespace tessera::bench {

struct NearestTask {
  int spans = 0;             ///< in each direction
  std::vector<Vec3> net;     ///< [i][j], spans + 3 in each direction
  std::vector<Vec3> points;  ///< from which the nearest points of the surface are searched
  double size = 0;           ///< of the surface

  int side() const { return spans + 3; }
};

/// One way in which a program does the task.
struct NearestRun {
  std::string program, way;
  std::size_t step = 1;                               ///< searches from points 0, step, 2 step ..
  std::function<double()> seconds;                    ///< searches once; returns the processor time
  std::function<double(std::size_t point)> distance;  ///< the distance found for a point of these; NaN for none
};

/// A program that was found. Its run must not outlive the task.
struct NearestPeer {
  std::string name;
  std::function<NearestRun(const NearestTask&)> run;
};
inline std::vector<NearestPeer>& nearest_peers() {
  static std::vector<NearestPeer> peers;
  return peers;
}

}  // namespace tessera::bench
