#pragma once
// The point of a mesh that is nearest to a given one, and its distance.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "tessera/mesh.h"

namespace tessera::render {

/// Returns a vertex's position in the model's coordinates: the one in double, if the mesh has such.
Vec3 position_of(const Mesh& mesh, std::size_t vertex);
/// Returns the point of the segment from a to b that is nearest to p.
Vec3 nearest_on_segment(const Vec3& p, const Vec3& a, const Vec3& b);

/// A tree of boxes over the triangles of a mesh. Immutable. Threads: any number of const calls.
class MeshDistance {
 public:
  /// Copies the parts of the mesh that it needs; quads are left out. Errors: invalid_argument (no triangle, an index
  /// out of range), non_finite (a vertex).
  static Result<MeshDistance> make(const Mesh& mesh);

  /// The distance from a point in the model's coordinates to the nearest point of the mesh, or `within` if none is that
  /// near.
  double distance(const Vec3& point, double within) const;
  /// The point of the mesh nearest to one in the model's coordinates, if it is nearer than `within`.
  std::optional<Vec3> nearest(const Vec3& point, double within) const;

 private:
  struct Triangle {
    Vec3 a, b, c;
  };
  /// A leaf holds triangles [first, first + count). An inner node has count 0; one child is next to it, the other at
  /// `first`.
  struct Node {
    Box3 box;
    std::uint32_t first = 0, count = 0;
  };
  void build(std::size_t begin, std::size_t end);

  std::vector<Triangle> triangles_;
  std::vector<Node> nodes_;
};

}  // namespace tessera::render
