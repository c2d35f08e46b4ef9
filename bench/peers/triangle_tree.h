#pragma once
// Nearest triangles of a mesh.

#include <cstdint>
#include <span>
#include <vector>

#include "peers/mesh_distance.h"

namespace tessera::bench {

/// A tree of boxes over triangles, which must outlive it.
class TriangleTree {
 public:
  TriangleTree() = default;
  explicit TriangleTree(std::vector<const SurfaceTriangle*> triangles);

  /// Returns the distance of the nearest triangle, or `most` if none is nearer than that.
  double distance(const Vec3& p, double most) const;
  bool empty() const { return triangles_.empty(); }

 private:
  struct Node {
    Box3 box;
    std::uint32_t first = 0, last = 0;  ///< triangles
    std::uint32_t right = 0;            ///< the second child; the first one follows the node. 0: a leaf
  };
  void build(std::uint32_t first, std::uint32_t last);

  std::vector<const SurfaceTriangle*> triangles_;
  std::vector<Node> nodes_;
};

}  // namespace tessera::bench
