#pragma once
// The distance of a surface from its mesh by dense samples: one measure for the meshes of all programs.

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "base/function_ref.h"
#include "tessera/geometry.h"
#include "tessera/mesh.h"

namespace tessera::bench {

/// A triangle of a mesh, and its parameters on the surface.
struct SurfaceTriangle {
  std::size_t face = 0;  ///< index of the face or the patch
  std::array<std::array<double, 2>, 3> parameters{};
  std::array<Vec3, 3> corners{};
};

/// The triangles of a Tessera mesh: `face` is the patch, parameters are the patch's. The mesh needs parameters and
/// patches.
std::vector<SurfaceTriangle> triangles_of(const Mesh& mesh);

/// A point of a face, by its parameters.
using FacePoint = FunctionRef<Vec3(std::size_t face, double u, double v)>;

/// The largest distance found of the surface from the mesh, at (steps + 1)(steps + 2) / 2 points of each triangle's
/// parameters. A point's distance is that to the nearest triangle of two rings around its own, by shared vertices: near
/// a pole the nearest triangle may lie at other parameters. Corners at the same position are one vertex. An even number
/// of steps samples the middles of the edges. Memory: 50 bytes per triangle.
double largest_distance(std::span<const SurfaceTriangle> mesh, FacePoint at, int steps);

}  // namespace tessera::bench
