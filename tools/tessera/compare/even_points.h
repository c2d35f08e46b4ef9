#pragma once
// Points spread evenly over the triangles of a mesh: equal areas get equally many.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "tessera/mesh.h"

namespace tessera::cli {

/// A point of a triangle of a mesh: A + b (B - A) + c (C - A), where A, B and C are its corners.
struct TrianglePoint {
  std::size_t triangle = 0;
  double b = 0, c = 0;  ///< at least 0, with a sum of at most 1
};

/// The cumulated areas of a mesh's triangles. Immutable. Memory: 8 bytes per triangle. The same points for any number
/// of threads.
///
/// Method: point k of n lies in the triangle at the share (k + 1/2) / n of the area. Within their triangles, points
/// follow an additive recurrence that fills the plane evenly, with the inverse of r and of its square, r^3 = r + 1.
///
/// Source: Roberts, The unreasonable effectiveness of quasirandom sequences, 2018.
class EvenPoints {
 public:
  /// Requires indices within the mesh and finite vertices; quads are left out. Errors: invalid_argument (no triangle
  /// has an area, or areas overflow).
  static Result<EvenPoints> make(const Mesh& mesh);

  double area() const { return sums_.back(); }  ///< of all triangles, above 0
  /// Returns point `k` of `count`; k < count.
  TrianglePoint point(std::size_t k, std::size_t count) const;

 private:
  std::vector<double> sums_;  ///< the areas of triangles up to this one
};

/// Returns the place of a point in the model's coordinates.
Vec3 place_of(const Mesh& mesh, const TrianglePoint& point);

}  // namespace tessera::cli
