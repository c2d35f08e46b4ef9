#pragma once
// How finely a mesh divides patches, by rates, tolerances or a budget of triangles, and how it joins them.

#include <cstdint>
#include <numbers>
#include <optional>
#include <vector>

#include "tessera/execution.h"
#include "tessera/geometry.h"
#include "tessera/patch_set.h"

#pragma GCC visibility push(default)
namespace tessera { inline namespace abi_0_1 {

/// A picture of width x height square pixels, whose middle lies in the direction of the target.
struct View {
  Vec3 eye, target;           ///< where the camera stands, and the point that it looks at
  Vec3 up{0, 0, 1};           ///< the direction that is up in the picture; replaced if parallel to the line of sight
  bool orthographic = false;  ///< true: parallel rays; false: rays that meet in the eye
  double field_of_view = 40 * std::numbers::pi / 180;  ///< across the shorter side, radians, above 0 and below pi
  double extent = 1;               ///< orthographic: the length in the model that the shorter side shows, above 0
  int width = 1280, height = 800;  ///< the picture's size in pixels, 1 to 1048576
  /// Perspective: points less deep than this in front of the eye are not seen. 0: a thousandth of the target's
  /// distance.
  double near_distance = 0;
};

/// How far mesh and surfaces may lie apart in a picture.
///
/// Every seen point of the mesh or of a surface lies within `pixels` of a point of the other; silhouettes too.
/// Distances along the rays are not bounded: combine this with an angle for shading.
///
/// - Patches with nothing in the frame are not divided for the picture.
/// - Patches that come nearer to the eye than the view's near distance, or pass behind it, keep a distance in space
///   instead, for the least depth at which anything of them is seen. So a camera may stand inside the model; a patch
///   that it almost touches takes many triangles.
struct PixelTolerance {
  double pixels = 0.5;  ///< above 0
  View view;            ///< the camera
};

/// Equal rates for all patches.
struct UniformRates {
  int u = 8;  ///< segments along u of every patch, 1 to 4096
  int v = 8;  ///< segments along v of every patch, 1 to 4096
};

/// The parameters that vertices of a mesh have, as texture coordinates for example.
enum class VertexParameters : std::uint8_t {
  surface,  ///< those of the surface: they run on from patch to patch of one surface (see PatchSource)
  unit,     ///< those of the surface as shares of its domain: 0 to 1 from side to side
  patch,    ///< those of the patch, 0 to 1
};

/// How the borders of patches and the edges of faces are joined.
struct Joining {
  /// The largest distance of borders that are joined: 0 to a twentieth of the set's size. 0 joins only borders of the
  /// same bits. Borders shorter than it become points.
  ///
  /// Empty: an eighth of the tolerance, without a tolerance 1e-6 of the set's size; but no more than an eighth of the
  /// smaller border's size. Borders then become points only if they are no longer than 2^-18 of their patch.
  std::optional<double> weld = {};
  /// The largest angle between normals that are joined, radians, 0 to pi. If empty, each patch has its own normals.
  ///
  /// Where the normals of two patches lie within this angle all along their common border, and point the same way, the
  /// border has one normal per vertex, that of the patch that comes first; so has a pole all around. All other borders
  /// are creases, with a normal for each patch. 0.01 takes in joins that are G1 up to rounding.
  ///
  /// The normals of the mesh decide this when its topology is made; edits that keep the topology do not change it. The
  /// proven `angle` is that of each patch's own normals.
  std::optional<double> crease_angle = {};
  /// Whether patches that meet share the vertices of their border by index, and a pole is one vertex. If false, each
  /// patch has its own vertices, whose positions are the same bits.
  ///
  /// With a crease angle, vertices are shared where normals are joined. Without a crease angle, vertices are shared
  /// everywhere and the mesh has no normals. The mesh has no parameters, unless TessellationOptions::parameters asks
  /// for them: then vertices are shared only within a surface, and not across its seams, such as u = 0 and u = 1 of a
  /// cylinder.
  bool share_vertices = false;
  /// Shapes: whether faces have the same vertices along their common edges, so that a closed shell has a closed mesh.
  bool close_edges = true;
  /// Shapes: edges along which the points of faces are farther apart than this stay open. A length, at least 0.
  std::optional<double> max_gap = {};
  /// Shapes: whether the plan lists the vertices along edges, for edge_vertices(). Needs `close_edges`.
  bool edge_vertices = false;
};

/// How finely patches are divided, and how they are joined: either `rates`, or any of a distance (`tolerance`,
/// `surface_tolerances` or `budget`), an angle and pixels.
struct TessellationOptions {
  /// Divides every patch at these rates, and proves nothing. Only `parameters`, `quads` and `isa` count beside it: a
  /// tolerance of any kind is an error.
  std::optional<UniformRates> rates = {};
  /// The largest distance between surfaces and mesh, in the model's lengths, above 0: every point of either lies within
  /// this distance of the other.
  std::optional<double> tolerance = {};
  /// The largest distance of each surface, by PatchSource::surface, instead of `tolerance`, so that one mesh without
  /// cracks holds what is near and what is far: each above 0. Where surfaces meet, both have the vertices of the finer
  /// one. Tessellation::tolerance() is the largest.
  std::vector<double> surface_tolerances = {};
  /// Whether tolerances are shares of the diagonal of PatchSet::model_box(), in make(), instead of lengths.
  bool relative = false;
  /// Levels of detail: the tolerance, at most `tolerance`, for which borders of patches are divided. Plans of one set
  /// with the same border tolerance meet without cracks, so each patch may be drawn by any of them. Coarse levels save
  /// the triangles within patches, not those at borders. For a `tolerance` that is a length, without any other limit,
  /// in sets without cut patches and edges of shapes; updates plan such a mesh anew.
  std::optional<double> border_tolerance = {};
  /// The largest angle by which the surface's normal turns within a triangle, radians, above 0, at most pi / 2.
  ///
  /// Any two surface normals over the triangle's parameters lie within this angle, and so does the shading that mixes
  /// the normals of its vertices. It does not bound the flat triangles' own normals: those of needles may point
  /// anywhere.
  ///
  /// There is no bound where the normal has no direction (at a cusp, or at a corner with parallel tangents), and hardly
  /// one where it turns at a rate of more than 32 radians over a patch. Such a patch gets at least `angle_rate`
  /// segments along each parameter instead and counts in patches_without_angle(). Poles have bounds. A short border
  /// that welding makes a point need not have one: then the patch is divided as one with a pole, and counts as well.
  std::optional<double> angle = {};
  int angle_rate = 64;                        ///< segments of patches without an angle bound, 1 to 4096
  std::optional<PixelTolerance> pixels = {};  ///< a tolerance in a camera's picture
  /// Finds the tolerance, where none is set: the smallest of the lengths 2^(k/128), 0.54 percent apart, that takes at
  /// most this many triangles, down to 1e-6 of the tolerance that one cell per patch keeps, without
  /// patches_beyond_tolerance(). Angle and pixels are kept as well. Edits keep the tolerance as long as the budget
  /// suffices.
  std::optional<std::uint64_t> budget = {};
  Joining joining = {};  ///< how vertices of patches that meet become one
  /// The parameters of vertices. Empty: those of the surface; with share_vertices none. The parameters of patches
  /// cannot be had with share_vertices.
  std::optional<VertexParameters> parameters = {};
  /// The largest number of triangles; a mesh that takes more is an error.
  std::uint64_t max_triangles = std::uint64_t{1} << 30;
  /// Looks for fewer triangles that keep a distance, and takes more time. It never adds triangles and saves a twentieth
  /// to a third of them, most on rational patches and on those that bend along u in one place and along v in another.
  ///
  /// Time: about a hundred times that of a plan without it, of the order of 100 us per bicubic patch; many seconds with
  /// a budget, which tries many plans. Meant for meshes that are drawn, stored or updated often.
  bool fewest = false;
  /// Whether whole cells are quads. With a tolerance, each cell that is not in a strip along a border is one quad, so
  /// there are none where strips take all cells, and in cut patches each cell that no loop touches; with rates, each
  /// cell that is not at a pole. The corners of a quad are those of a box of the patch's parameters, in which both of
  /// its triangles lie: all that is proven of the mesh holds for both, by either diagonal.
  bool quads = false;
  /// Edits: a patch keeps its segments while they keep the tolerances and have at most (1 + spare) times the cells of
  /// the best ones. Finite, at least 0.
  double spare = 0.25;
  /// Edits: the part of the tolerances that new segments leave for edits to come, from 0 to 0.9. Each patch is divided
  /// for 1 - headroom of them, and keeps its segments while edits keep them in full, so the triangles of an animation
  /// rarely change. Cells become 1 / (1 - headroom) times as many. Not for a budget; cut patches are cut anew anyway.
  double headroom = 0;
  std::optional<Isa> isa = {};  ///< default_isa() if empty
  /// Double: the mesh has positions in double as well, in the model's coordinates, and the bounds hold for these.
  ///
  /// Meant for parts so far apart, and tolerances so small, that float positions do not keep them. All vertices and
  /// normals then come from the set's double control points, in about a microsecond per vertex. Borders are one edge
  /// where their float control points are the same bits and their double ones lie within 2^-20 of the border's size of
  /// each other. Other borders are welded within 2^-50 of the largest coordinate, a few units in the last place.
  Precision precision = Precision::single_precision;
};

}}  // namespace tessera::abi_0_1
#pragma GCC visibility pop
