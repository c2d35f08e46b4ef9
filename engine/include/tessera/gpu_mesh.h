#pragma once
// Prepares meshes for a GPU: tangents, 16-bit indices, the ranges of surfaces, and clusters of triangles.
//
// Memory: results own theirs; arguments are not kept. Threads: any number of calls at once on const meshes.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "tessera/execution.h"
#include "tessera/geometry.h"
#include "tessera/mesh.h"
#include "tessera/patch_set.h"
#include "tessera/status.h"
#include "tessera/tessellation_options.h"

#pragma GCC visibility push(default)
namespace tessera { inline namespace abi_0_1 {

/// Returns the tangent of each vertex, four floats: the unit vector along which u grows, perpendicular to the normal,
/// and the sign with which cross(normal, tangent) points along v. So normal maps need no tangents by triangles.
///
/// - `mesh`: with parameters, normals and patches, as the plan of `set` has written it.
/// - `parameters`: the kind that the mesh has.
///
/// A vertex takes the derivatives of the patch of its first face. Where these vanish, at a pole, the tangent is
/// perpendicular to the other derivative, or else any vector perpendicular to the normal; where the normal is zero, so
/// is the tangent.
///
/// Errors: invalid_argument (a mesh without parameters or normals; index = the vertex: parameters outside of its patch;
/// index = the face: no such patch), count_mismatch (not one patch per face), cancelled, out_of_memory.
Result<std::vector<float>> tangents(const Mesh& mesh, const PatchSet& set, VertexParameters parameters,
                                    const Execution& execution = {});

/// Returns the indices of triangles in 16 bits. Errors: unsupported (more than 65536 vertices), invalid_argument (an
/// index out of range).
Result<std::vector<std::uint16_t>> short_indices(const Mesh& mesh);

/// Orders the triangles of each part, or of the whole mesh if it has none, so that their vertices are in a cache of so
/// many vertices more often. Vertices stay, and each triangle keeps its first corner.
///
/// - `cache_size`: 3 to 1024.
///
/// Errors, with the mesh unchanged: invalid_argument (the cache size; index = the triangle: a vertex out of range;
/// index = the part: one that does not begin where the one before ends), count_mismatch (patches; parts that are not
/// all triangles), out_of_memory. Time: linear.
///
/// Source: Sander, Nehab and Barczak 2007, Fast triangle reordering for vertex locality and reduced overdraw.
Status order_for_vertex_cache(Mesh& mesh, int cache_size = 16);

/// A run of a mesh's triangles and of its vertices, such as those of one surface.
struct MeshRange {
  std::uint32_t surface = 0;                           ///< PatchSource::surface
  std::size_t first_triangle = 0, triangle_count = 0;  ///< a run of the mesh's triangles
  std::size_t first_quad = 0, quad_count = 0;          ///< a run of the mesh's quads
  /// The vertices from the lowest to the highest that these faces have. Ranges overlap where surfaces share vertices.
  std::size_t first_vertex = 0, vertex_count = 0;
  Box3 box;          ///< of these faces' vertices, in the model
  double bound = 0;  ///< the largest of the patches' bounds, infinite if one has none
};

/// Returns the ranges of surfaces, in the order of the faces.
///
/// - `mesh`: with patches, which are those of `set`.
/// - `bounds`: Tessellation::bounds(), or empty for a mesh without: all bounds are infinite then.
///
/// Errors: invalid_argument (index = the face: no such patch, a vertex out of range), count_mismatch (not one patch per
/// face; bounds).
Result<std::vector<MeshRange>> surface_ranges(const Mesh& mesh, const PatchSet& set, std::span<const float> bounds);

/// Some triangles of a mesh that lie together, for culling and for mesh shaders.
struct MeshCluster {
  std::uint32_t first_triangle = 0, triangle_count = 0;  ///< places in MeshClusters::triangles
  std::uint32_t first_vertex = 0, vertex_count = 0;      ///< places in MeshClusters::vertices
  Box3 box;                                              ///< of its vertices, in the model
  Vec3 axis;                                             ///< the unit vector that the triangles' normals lie around
  /// The normals lie within so many radians of `axis`; pi if they go all ways. Seen from the eye e, all triangles face
  /// away if the angle from `axis` to p - e is below pi / 2 - spread for every p of the box.
  double spread = 0;
  double bound = 0;  ///< its triangles lie within this of their patches, proven; infinite if one has no bound
};

/// The clusters of a mesh: each triangle is in one.
struct MeshClusters {
  std::vector<MeshCluster> clusters;     ///< each with a run of the lists below
  std::vector<std::uint32_t> triangles;  ///< cluster after cluster, numbers of the mesh's triangles
  std::vector<std::uint32_t> vertices;   ///< cluster after cluster, numbers of the mesh's vertices
  std::vector<std::uint8_t> corners;     ///< three per triangle, as `triangles`: places among its cluster's vertices
};

/// How clusters are made.
struct ClusterOptions {
  int max_triangles = 128;  ///< 1 to 512
  int max_vertices = 256;   ///< 3 to 256
};

/// Divides a mesh's triangles into clusters, by cutting boxes of their middles in halves. Mixed meshes have clusters of
/// their triangles alone: see split_quads().
///
/// - `bounds`: Tessellation::bounds() for a mesh with patches, or empty: all bounds are infinite then.
///
/// Errors: invalid_argument (options out of range; index = the triangle: a vertex or a patch out of range),
/// count_mismatch (bounds without patches), cancelled, out_of_memory. Time: n log n for n triangles.
Result<MeshClusters> make_clusters(const Mesh& mesh, std::span<const float> bounds, const ClusterOptions& options = {},
                                   const Execution& execution = {});

}}  // namespace tessera::abi_0_1
#pragma GCC visibility pop
