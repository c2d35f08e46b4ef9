#pragma once
// Meshes as something that rays meet: a patch for each triangle.

#include <array>
#include <cstdint>
#include <vector>

#include "tessera/mesh.h"
#include "tessera/patch_set.h"
#include "tessera/ray_scene.h"

namespace tessera::render {

/// The triangles of meshes as bilinear patches, with normals to shade and edges to draw.
///
/// The patch of a triangle ABC has A at u = 0, B at (1,0) and C at (1,1). Triangles without area are left out. A quad
/// is two triangles. Threads: const calls from any number of threads.
class MeshPatches {
 public:
  /// Adds the faces of a mesh. Errors: invalid_argument (an index out of range), non_finite (a vertex).
  Status add(const Mesh& mesh);

  std::size_t triangle_count() const { return triangles_.size(); }  ///< triangles with an area
  /// Packs the triangles in the order of the hits' patches. Errors: invalid_argument (no triangle with an area), and
  /// those of PatchSet.
  Result<PatchSet> pack() const;

  /// The normal at a hit: interpolated from the vertices' normals, or the triangle's own if they have none.
  Vec3 normal(const Hit& hit) const;
  /// The patch of the hit triangle, by Mesh::patches. Requires meshes that have patches.
  std::uint32_t patch(const Hit& hit) const { return triangles_[hit.patch].patch; }
  /// The point of the triangle's edges that is nearest to a hit. The diagonal of a quad is no edge.
  Vec3 nearest_edge(const Hit& hit) const;

 private:
  struct Triangle {
    std::array<Vec3, 3> corners;
    std::array<Vec3, 3> normals;  ///< zero: the triangle's own
    std::array<bool, 3> is_edge;  ///< from corner k to the next
    std::uint32_t patch = 0;      ///< 0 in meshes without patches
  };
  void add_triangle(const Mesh& mesh, const std::array<std::uint32_t, 3>& corners, const std::array<bool, 3>& is_edge,
                    std::uint32_t patch);

  std::vector<Triangle> triangles_;
};

}  // namespace tessera::render
