#pragma once
// Indexed meshes of triangles and quads: memory and views to write them to, their parts, and a check for faults.
//
// Memory: meshes own theirs; views refer to the caller's. Threads: any number of calls at once on const meshes.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tessera/colour.h"
#include "tessera/geometry.h"
#include "tessera/status.h"
#include "tessera/strided_view.h"

#pragma GCC visibility push(default)
namespace tessera { inline namespace abi_0_1 {

/// The sizes of a mesh, in records.
struct MeshCapacity {
  std::size_t vertices = 0;   ///< records of the vertex views
  std::size_t triangles = 0;  ///< three indices each
  std::size_t quads = 0;      ///< four indices each
};

/// Where a mesh is written. An empty view leaves its attribute out; positions and indices are required.
struct MeshViews {
  View3<float> position = {};             ///< relative to the origin of the patch set; required without model_position
  View3<float> normal = {};               ///< unit, or zero where undefined
  View2<float> parameter = {};            ///< (u,v), see TessellationOptions::parameters
  std::span<std::uint32_t> patch = {};    ///< the patch of each triangle
  std::span<std::uint32_t> indices = {};  ///< three per triangle, counter-clockwise seen from where r_u x r_v points
  /// Four per quad, the same way around. Required by plans with quads, and must be empty for all others. With quads,
  /// `patch` and `indices` hold only the other triangles, those of strips and at poles.
  std::span<std::uint32_t> quads = {};
  std::span<std::uint32_t> quad_patch = {};  ///< the patch of each quad
  /// Positions in double, in the model's coordinates. Required by plans with positions in double, and must be empty for
  /// all others: see TessellationOptions::precision.
  View3<double> model_position = {};
};

/// Triangles and quads that belong together, such as those of one surface.
struct MeshPart {
  std::string name;                                    ///< the surface's name
  std::size_t first_triangle = 0, triangle_count = 0;  ///< a run of the mesh's triangles
  std::size_t first_quad = 0, quad_count = 0;          ///< a run of the mesh's quads
  std::optional<Colour> colour = {};                   ///< as the file states it
};

/// A mesh that owns its memory, interleaved by attribute: 3 floats per position or normal, 2 per parameter.
struct Mesh {
  Vec3 origin;                              ///< positions plus this are the model's coordinates
  std::vector<float> positions;             ///< three per vertex, relative to the origin
  std::vector<float> normals;               ///< empty, or as long as positions
  std::vector<float> parameters;            ///< empty, or two per vertex
  std::vector<std::uint32_t> patches;       ///< empty, or one per triangle
  std::vector<std::uint32_t> indices;       ///< three per triangle, counter-clockwise from where the normal points
  std::vector<std::uint32_t> quads;         ///< four per quad, the same way around; faces beside the triangles
  std::vector<std::uint32_t> quad_patches;  ///< empty, or one per quad
  std::vector<MeshPart> parts;              ///< empty, or runs one after the other that together are all faces
  std::vector<double> model_positions;      ///< empty, or as long as positions: positions in the model's coordinates

  std::size_t vertex_count() const { return positions.size() / 3; }
  std::size_t triangle_count() const { return indices.size() / 3; }
  std::size_t quad_count() const { return quads.size() / 4; }
  /// Whether there are faces, and a patch for each.
  bool has_patches() const {
    return !(patches.empty() && quad_patches.empty()) && patches.size() == triangle_count() &&
           quad_patches.size() == quad_count();
  }
  MeshViews views();  ///< views of the mesh's memory, which must not be reallocated while they are used
};

/// Returns the mesh with each quad replaced by two triangles, on either side of the diagonal from its first corner to
/// its third.
///
/// The mesh's triangles come first and then those of quads; with parts, in this order within each part. Patches are
/// kept if each face has one.
///
/// Errors: count_mismatch (indices that are not three per triangle or four per quad; parts that are not all faces),
/// invalid_argument (a part that does not begin where the one before ends; index = the part).
Result<Mesh> split_quads(const Mesh& mesh);

/// The faults of a mesh, counted. Vertices at bit-equal positions count as one, by model_positions if there are any. A
/// quad counts as the two triangles that split_quads() makes of it.
struct MeshReport {
  std::size_t vertices = 0;            ///< as stored
  std::size_t distinct_positions = 0;  ///< vertices of equal position counted once
  std::size_t triangles = 0;           ///< as stored, and two per quad
  std::size_t quads = 0;               ///< as stored
  std::size_t open_edges = 0;          ///< edges of one triangle
  std::size_t non_manifold_edges = 0;  ///< edges of three triangles or more
  std::size_t inconsistent_edges = 0;  ///< edges whose two triangles run along it the same way
  std::size_t t_junctions = 0;         ///< vertices of open edges that lie inside another open edge
  /// Non-degenerate triangles that face away from the sum of their corners' normals.
  std::size_t flipped_triangles = 0;
  /// Two corners in one place, or no area. Edges of the former are not counted above; those of the latter are, because
  /// a triangle that is a line closes the gap between one edge and two.
  std::size_t degenerate_triangles = 0;
  std::size_t non_finite_vertices = 0;  ///< NaN or infinity in a position or a normal
  /// Whether there are non-degenerate triangles, and they leave no border.
  bool closed() const { return triangles > degenerate_triangles && open_edges == 0 && non_manifold_edges == 0; }
};

/// Counts the faults of a mesh. Errors: invalid_argument (an index out of range, index = its place among those of
/// triangles or of quads; counts that don't fit each other). Memory: 40 bytes per triangle, 55 with positions in
/// double.
Result<MeshReport> check(const Mesh& mesh);

}}  // namespace tessera::abi_0_1
#pragma GCC visibility pop
