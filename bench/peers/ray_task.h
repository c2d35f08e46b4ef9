#pragma once
// The work by which ray casters are compared: the closest hits of a camera's rays on a bicubic B-spline surface over
// uniform knots, one thread.

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "tessera/bezier_patch.h"
#include "tessera/nurbs_surface.h"
#include "tessera/patch_set.h"
#include "tessera/ray_scene.h"

namespace tessera::bench {

/// Segments per patch and direction for programs that split a surface into facets.
inline constexpr int facets_per_side = 8;

/// Rays from one eye in rows of pixels: along forward + (x - 1/2) right + (1/2 - y) up, x and y in (0, 1).
struct RayCamera {
  Vec3 eye, forward, right, up;
  int side = 0;  ///< pixels in each direction

  Ray ray(std::size_t pixel) const {
    const auto n = static_cast<std::size_t>(side);
    const double x = (static_cast<double>(pixel % n) + 0.5) / side, y = (static_cast<double>(pixel / n) + 0.5) / side;
    return {.origin = eye, .direction = forward + (x - 0.5) * right + (0.5 - y) * up};
  }
  std::size_t rays() const { return static_cast<std::size_t>(side) * static_cast<std::size_t>(side); }
};

struct RayTask {
  int spans = 0;          ///< in each direction
  std::vector<Vec3> net;  ///< [i][j], spans + 3 in each direction
  RayCamera camera;
  Box3 box;             ///< of the patches' control points
  double size = 0;      ///< its diagonal
  const PatchSet& set;  ///< the surface, a patch per span: patch (a, b) is number a * spans + b

  int side() const { return spans + 3; }
};

/// One way in which a program does the task.
struct RayRun {
  std::string program, way;
  std::size_t step = 1;                      ///< casts rays 0, step, 2 step ..
  std::function<double()> seconds;           ///< casts them once; returns the processor time
  std::function<double(std::size_t ray)> t;  ///< of a ray that was cast; infinite for a miss
};

/// A program that was found. Its runs must not outlive the task.
struct RayPeer {
  std::string name;
  std::function<std::vector<RayRun>(const RayTask&)> runs;
};
inline std::vector<RayPeer>& ray_peers() {
  static std::vector<RayPeer> peers;
  return peers;
}

}  // namespace tessera::bench
