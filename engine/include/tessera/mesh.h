#pragma once
// Indexed meshes of triangles and quads.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "tessera/geometry.h"
#include "tessera/status.h"
#include "tessera/strided_view.h"

#pragma GCC visibility push(default)
namespace tessera::inline abi_0_1 {

/// What a mesh needs, in records.
struct MeshCapacity {
  std::size_t vertices = 0;   ///< records of the vertex views
  std::size_t triangles = 0;  ///< three indices each
  std::size_t quads = 0;      ///< four indices each
};

/// Where a mesh is written. Empty views are not wanted; positions and indices are required.
struct MeshViews {
  View3<float> position = {};             ///< relative to the origin of the patch set; required without position_f64
  View3<float> normal = {};               ///< unit, or zero where undefined
  View2<float> parameter = {};            ///< (u,v) of the patch, in [0,1]^2
  std::span<std::uint32_t> patch = {};    ///< the patch of each triangle
  std::span<std::uint32_t> indices = {};  ///< three a triangle, counter-clockwise seen from where r_u x r_v points
  /// Four a quad, the same way around. If this is not empty, whole cells come here, and `patch` and `indices` hold the
  /// other triangles alone, those of strips and at poles; the plan's quad_capacity() says how many of each.
  std::span<std::uint32_t> quads = {};
  std::span<std::uint32_t> quad_patch = {};  ///< the patch of each quad
  /// Positions in double, in the model's coordinates. For plans with positions in double, which require it, alone: see
  /// CertifiedOptions::precision.
  View3<double> position_f64 = {};
};

/// Triangles and quads that belong together, such as those of one surface.
struct MeshPart {
  std::string name;                                    ///< of the surface
  std::size_t first_triangle = 0, triangle_count = 0;  ///< a run of the mesh's triangles
  std::size_t first_quad = 0, quad_count = 0;          ///< and one of its quads
};

/// A mesh that owns its memory, interleaved by attribute: 3 floats a position or normal, 2 a parameter.
struct Mesh {
  Vec3 origin;                              ///< add it to positions to get the model's coordinates
  std::vector<float> positions;             ///< three a vertex, relative to the origin
  std::vector<float> normals;               ///< empty, or as long as positions
  std::vector<float> parameters;            ///< empty, or two a vertex
  std::vector<std::uint32_t> patches;       ///< empty, or one a triangle
  std::vector<std::uint32_t> indices;       ///< three a triangle, counter-clockwise from where the normal points
  std::vector<std::uint32_t> quads;         ///< four a quad, the same way around, beside the triangles
  std::vector<std::uint32_t> quad_patches;  ///< empty, or one a quad
  std::vector<MeshPart> parts;              ///< empty, or runs one after the other that together are all faces
  std::vector<double> positions_f64;        ///< empty, or as long as positions: these in the model's coordinates

  std::size_t vertex_count() const { return positions.size() / 3; }  ///< of positions
  std::size_t triangle_count() const { return indices.size() / 3; }  ///< of indices
  std::size_t quad_count() const { return quads.size() / 4; }        ///< of quads
  /// Whether there are faces, and the patch of each.
  bool has_patches() const {
    return !(patches.empty() && quad_patches.empty()) && patches.size() == triangle_count() &&
           quad_patches.size() == quad_count();
  }
  MeshViews views();  ///< of the mesh's memory, which must stay in place
};

/// The mesh with two triangles in each quad's place, on either side of the diagonal from its first corner to its third:
/// all triangles first and then these, or the same part by part; patches, if each face has one. Errors: count_mismatch (indices
/// that are not three a triangle or four a quad; parts that are not all faces), invalid_argument (a part that does not
/// follow on the one before; index = the part).
Result<Mesh> split_quads(const Mesh& mesh);

/// Counts the faults of a mesh. Vertices at bit-equal positions, those in double where there are any, count as one,
/// and a quad as the two triangles that split_quads() makes of it.
struct MeshReport {
  std::size_t vertices = 0;              ///< as stored
  std::size_t distinct_positions = 0;    ///< vertices of equal position counted once
  std::size_t triangles = 0;             ///< as stored, and two a quad
  std::size_t quads = 0;                 ///< as stored
  std::size_t open_edges = 0;            ///< edges of one triangle
  std::size_t non_manifold_edges = 0;    ///< edges of three triangles or more
  std::size_t inconsistent_edges = 0;    ///< edges whose two triangles run along it the same way
  std::size_t t_junctions = 0;           ///< vertices of open edges that lie inside another open edge
  std::size_t flipped_triangles = 0;     ///< sound ones that look the other way than the normals at their corners
  std::size_t degenerate_triangles = 0;  ///< two corners in one place, or no area; not counted in edges
  std::size_t non_finite_vertices = 0;   ///< NaN or infinity in a position or a normal
  /// Whether its sound triangles, of which there are some, leave no border.
  bool closed() const { return triangles > degenerate_triangles && open_edges == 0 && non_manifold_edges == 0; }
};

/// Counts, in 40 bytes a triangle, or 55 with positions in double. Errors: invalid_argument (an index out of range: its place among those of triangles or
/// quads; counts that don't fit).
Result<MeshReport> check(const Mesh& mesh);

}  // namespace tessera::inline abi_0_1
#pragma GCC visibility pop
