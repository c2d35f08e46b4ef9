#pragma once
// Turns patches into triangles and quads: at uniform rates, or so that a tolerance in length, angle or pixels provably
// holds without cracks. Meshes follow edits of control points.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <numbers>
#include <optional>
#include <span>
#include <vector>

#include "tessera/evaluate.h"
#include "tessera/execution.h"
#include "tessera/geometry.h"
#include "tessera/mesh.h"
#include "tessera/nurbs_surface.h"
#include "tessera/patch_set.h"
#include "tessera/status.h"

#pragma GCC visibility push(default)
namespace tessera { inline namespace abi_0_1 {

struct Model;

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

/// How finely patches are divided: either `rates`, or at least one of tolerance, angle, pixels and smallest.
struct TessellationOptions {
  /// Divides every patch at these rates, and proves nothing. Only `quads` and `isa` count beside it: a tolerance of any
  /// kind is an error.
  std::optional<UniformRates> rates = {};
  /// The largest distance between surfaces and mesh, in the model's lengths, above 0: every point of either lies within
  /// this distance of the other.
  std::optional<double> tolerance = {};
  /// Whether the tolerance is a share of the diagonal of PatchSet::model_box(), in make(), instead of a length.
  bool relative = false;
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
  /// everywhere and the mesh has no normals. A shared vertex belongs to the patch that comes first, or to that
  /// which the others are welded to: its parameters are those of that patch.
  bool share_vertices = false;
  /// Shapes: whether faces have the same vertices along their common edges, so that a closed shell has a closed mesh.
  bool close_edges = true;
  /// Shapes: edges along which the points of faces are farther apart than this stay open. A length, at least 0.
  std::optional<double> max_gap = {};
  /// The largest number of triangles; a mesh that takes more is an error.
  std::uint64_t max_triangles = std::uint64_t{1} << 30;
  /// Finds the tolerance: the smallest of the lengths 2^(k/128), 0.54 percent apart, for which max_triangles suffice,
  /// down to 1e-6 of the tolerance that one cell per patch keeps, without patches_beyond_tolerance(). Angle and pixels
  /// are kept as well. Edits keep the tolerance as long as max_triangles suffice.
  bool smallest = false;
  /// Looks for fewer triangles that keep a distance, and takes more time. It never adds triangles and saves a twentieth
  /// to a third of them, most on rational patches and on those that bend along u in one place and along v in another.
  ///
  /// Time: about a hundred times that of a plan without it, of the order of 100 us per bicubic patch; many seconds with
  /// `smallest`, which tries many plans. Meant for meshes that are drawn, stored or updated often.
  bool fewest = false;
  /// Whether whole cells are quads. With a tolerance, each cell that is not in a strip along a border is one quad, so
  /// there are none where strips take all cells, and in cut patches each cell that no loop touches; with rates, each
  /// cell that is not at a pole. The corners of a quad are those of a box of the patch's parameters, in which both of
  /// its triangles lie: all that is proven of the mesh holds for both, by either diagonal.
  bool quads = false;
  /// Edits: a patch keeps its segments while they keep the tolerances and have at most (1 + spare) times the cells of
  /// the best ones. Finite, at least 0.
  double spare = 0.25;
  std::optional<Isa> isa = {};  ///< default_isa() if empty
  /// Double: the mesh has positions in double as well, in the model's coordinates, and the bounds hold for these.
  ///
  /// Meant for parts so far apart, and tolerances so small, that float positions do not keep them. All vertices and
  /// normals then come from the set's double control points, in about a microsecond per vertex. Borders are one edge
  /// where their float control points are the same bits and their double ones lie within 2^-20 of the border's size of
  /// each other. Other borders are welded within 2^-50 of the largest coordinate, a few units in the last place.
  Precision precision = Precision::single_precision;
};

/// New control points of a spline surface that the patches of a set were converted from by make_patch_set().
struct SurfaceEdits {
  /// The surface: its degrees, knots, weights and domain; its own control points do not count. A copy of the same
  /// object each time is fastest.
  BSplineSurface spline;
  /// All control points `[i][j]` as they are now, as many as the spline has, not premultiplied.
  std::span<const Vec3> points;
  /// The points i * count_v() + j that differ from those of the last update that succeeded. Empty: any may.
  std::span<const std::uint32_t> moved = {};
  std::uint32_t surface = 0;  ///< PatchSource::surface of its patches
  Affine placement = {};      ///< maps the control points into the set
};

/// The changes of an update besides the vertices.
struct MeshChange {
  /// Whether the mesh has other triangles or vertices than before. If so, nothing was written, and the plan is that of
  /// the new mesh, for capacity(), allocate() and run().
  bool topology = false;
  std::size_t patches = 0;  ///< how many patches are divided, or joined to others, in another way than before
};

/// The plan of a mesh: how each patch is divided, and where its vertices and triangles lie.
///
///   auto plan = Tessellation::make(set, {.tolerance = 1e-3});
///   Mesh mesh = *plan->allocate();
///   plan->run(set, mesh.views());
///   auto change = plan->update(set, {patches, points}, mesh.views());  // each frame
///   if (change && change->topology) mesh = *plan->allocate(), plan->run(set, mesh.views());
///
/// Cells: each patch has about the fewest that keep the tolerances. With an angle or pixels, they lie where the patch
/// bends: each eighth of u and of v has a rate of its own where that saves cells. With a distance alone, the cells of a
/// patch have one size, unless TessellationOptions::fewest is set. A flat convex quadrilateral takes two triangles.
///
/// Bounds: the bound of a patch is proven. It is the sum of a bound on the chords, the rounding of float vertices and
/// the set's fit error. The second derivatives of the patch bound the chords (Filip, Magedson, Markot 1986); for a
/// rational patch those of its homogeneous form, or those of exact numerators. So a cylinder takes as many triangles at
/// any height. Scaled sweeps rho(v) E(u) + T(v), such as surfaces of revolution, extrusions and cones, need no bound on
/// the mixed derivative.
///
/// Local decisions: the division and the vertices of a patch depend on the patch, the options, the set's origin and the
/// patches that it touches, or whose borders lie within the weld. Patches elsewhere and their order make no difference.
/// Exceptions:
///
/// - lengths that are shares of the set's size, TessellationOptions::fewest and `smallest`
/// - the patches that borders of these are moved to, by welding or to others of the same float bits; the faces behind
///   the other edges of a face whose chords cross
/// - with pixels: whole patches beside cut ones, see below
///
/// Vertices: usually sums of floats, in SIMD. If the rounding of these sums takes more than a quarter of the tolerance,
/// or all that pixels leave, as for parts far from the set's origin with a small tolerance, then the vertices of the
/// patch are sums of doubles instead, from the set's double control points. These are rounded once to float: off by
/// half a unit in the last place of a position relative to the set's origin. They take several times as long, and a
/// mesh that has any is never written past the caches.
///
/// - `smallest`: if one patch needs doubles, all patches take them.
/// - Pixels: a whole patch beside a cut patch of doubles takes doubles too.
/// - A common border of a patch of doubles and one of floats has the vertices of doubles.
/// - Two borders of doubles that were equal when the plan was made are welded from then on: after edits, both have the
///   vertices of one.
///
/// No cracks: borders whose packed control points are the same bits, in either direction, run at one rate, and their
/// vertices are the same bits in both patches. Each patch has an inner grid at its own rates, and strips of triangles
/// between that grid and its borders. A collapsed border is one point without triangles on it.
///
/// Welding: a border that equals no other by its bits is joined to the nearest one within TessellationOptions::weld; by
/// default, to the nearest of those that equal no other either.
///
/// - The border that moves depends on the two alone. Of three or more that are joined, all take the vertices of one. A
///   slit narrower than the weld closes. A patch thinner than the weld keeps its own borders apart.
/// - The two may run in either direction and have any degrees, polynomial or rational. Their points at equal parameters
///   lie within the tolerance, proven by their control points raised to one degree.
/// - Not joined: rational curves of one shape whose parameters run at different speeds; one long border and two short
///   ones.
/// - Corners of joined borders become one corner.
/// - Borders whose control points lie in a box no larger than the weld become points, as collapsed ones are. Those of a
///   needle, which would vanish by it, do not, unless a neighbour with triangles has one of its long borders.
/// - The bounds include how far vertices are moved.
///
/// Trimming loops: of a patch that they cut, the mesh shows what an odd number of them encloses.
///
/// - All bounds hold between the mesh and the kept part, in both directions; those of pixels and angles too.
/// - With an angle, the edges along loops also turn by about that angle from one to the next; this is not proven.
/// - Patches of one face share the vertices of their common sides; whole patches are as without loops.
/// - Cut patches take positions from the set's double control points. They are not for uniform rates.
///
/// Edges of shapes (see Shape): all faces along an edge get vertices at the same parameters of the edge, and these have
/// one position. So the mesh of a closed shell has no open edges at any tolerance, and those of an open shell are its
/// borders.
///
/// - A vertex of several faces stands in the middle of the box of their points, or at the shape's vertex within it. How
///   far it leaves a face is no part of bound(), see gap(): faces farther apart than the tolerance are meshed and closed.
/// - Vertices of faces at parameters of an edge nearer than 1e-5 of its range, and a small part of the tolerance, count
///   as one; gap() includes this.
/// - Chords of trimmed faces end at common parameters. A whole patch keeps its even borders: where it needs a vertex
///   more, one triangle becomes a fan.
/// - Borders along such edges are joined by them, not by welding.
/// - Not closed: edges of one face, edges wider than TessellationOptions::max_gap, faces in crossed_patches() or
///   PatchSet::trim_faults(), loops that leave the domain or name no edges, patches that are curves, meshes with rates.
/// - Sets with edges or cut patches: share_vertices makes one of all vertices at one position (and of one normal, if
///   there are normals), of touching bodies too. A crease angle joins normals vertex by vertex.
///
/// Layout of the vertices, patch after patch. Tolerances: the inner points `[iu - 1][iv - 1]`, then the border points
/// counter-clockwise from (0,0), each corner once; shared points that belong to another patch are left out. Rates: all
/// points `[iu][iv]`, so vertex (patch * (rates.u + 1) + iu) * (rates.v + 1) + iv. Cut patches: in no stated order.
/// Vertices that edges add to a whole patch follow its own.
///
/// Edits: an update plans and writes all of a set with cut patches or edges anew; loops stay as they are.
///
/// Threads: any number of const calls; an update excludes every other call.
///
/// Memory: with rates 24 bytes per patch. With tolerances 1 KiB per patch to make and 256 bytes per patch to keep; the
/// first update takes another 256 bytes per patch. At most about 512 KiB per set for tables that its small plans share.
/// With an angle or pixels, 8 (degree + 5) bytes for each segment along a parameter or border of patches whose cells
/// lie where they bend: less than their triangles take. With an angle and `smallest`, half a KiB more to make it.
class Tessellation {
 public:
  /// Makes a plan.
  ///
  /// Errors:
  /// - invalid_argument (neither rates nor a tolerance of any kind, or both; a rate out of range; a tolerance that is
  ///   not above 0)
  /// - invalid_argument (tolerances that no patch keeps, see patches_beyond_tolerance(); the message names about the
  ///   smallest one that all keep, or how many triangles it takes)
  /// - invalid_argument (a view without a picture; a weld, a crease angle or `spare` out of range)
  /// - invalid_argument (more triangles or vertices than the limits; the message says how many triangles the mesh takes)
  /// - invalid_argument (max_triangles below what one cell per patch takes)
  /// - unsupported (the set has no float Bernstein blocks; it has cut patches, and rates are wanted)
  /// - isa_unavailable, cancelled
  static Result<Tessellation> make(const PatchSet& set, const TessellationOptions& options,
                                   const Execution& execution = {});

  Tessellation(Tessellation&&) noexcept;
  Tessellation& operator=(Tessellation&&) noexcept;
  ~Tessellation();

  /// Returns the distance that the mesh is proven to keep: the largest of bounds() that is finite; infinite with rates.
  /// It is at most the tolerance, unless there are patches_beyond_tolerance(). Like all bounds of a plan it holds for
  /// the set and the revision that the plan was made or updated for.
  double bound() const;
  /// Whether the bounds are proven; false with rates, and where the set's fit error is only sampled.
  bool certified() const;
  /// Returns the distance that the plan keeps: the tolerance, as a length, or the smallest one that make() found.
  /// Infinite if neither was set.
  double tolerance() const;
  /// Returns the proven distance of each patch, infinite for crossed_patches(); empty with rates.
  std::span<const float> bounds() const;
  /// Returns the proven angle, radians: the largest of the patches that have a bound. 0 if no angle was set.
  double angle() const;
  std::size_t patches_without_angle() const;  ///< how many have no bound
  /// Returns the proven angle of each patch, infinite where there is none; empty if no angle was set.
  std::span<const float> angles() const;
  /// Returns the proven distance in the picture, in pixels. 0 if pixels were not set.
  double pixels() const;
  /// Returns the proven pixels of each patch, 0 where nothing is seen; empty if pixels were not set.
  std::span<const float> pixel_bounds() const;
  /// Returns the largest distance by which vertices had to leave a surface because the faces of a shape fail to meet:
  /// every point of the mesh lies within bound() + gap() of a face, and the other way round. 0 without edges.
  double gap() const;
  /// Returns the largest such distance along each edge: of the first instance's shape, then the next; see
  /// Model::instances. About 0 where faces meet; of edges that max_gap leaves open, half of their faces' distance.
  /// Empty if no loop of the set names edges.
  std::span<const float> edge_gaps() const;
  /// Returns how many borders were joined by welding and not by their bits, those that became points among them.
  std::size_t welded_borders() const;
  /// Returns how many edges of triangles lie on borders that are joined to no other. check() counts fewer where such
  /// borders have vertices at the same positions by chance, and may count others where loops of a face run over each
  /// other within the rounding of positions. 0 with rates, where it is not known.
  std::size_t open_edges() const;
  /// Returns the patches that have no triangles, because their trimming loops could not be made a polygon.
  std::span<const std::uint32_t> crossed_patches() const;
  /// Returns the patches whose bounds exceed the tolerances, by growing patch: those whose loops are too rough, for
  /// example because curves leave gaps; those whose rounding, welding or fit error takes all of a tolerance; those that
  /// need more than 4096 segments along a parameter. They are meshed as finely as helps; all bounds say what they keep.
  std::span<const std::uint32_t> patches_beyond_tolerance() const;
  MeshCapacity capacity() const;  ///< the exact sizes of the mesh
  /// Returns where a patch's vertices, triangles and quads begin, or all end. Requires share_vertices to be false.
  MeshCapacity before(std::size_t patch) const;
  /// Returns a mesh of capacity() with all attributes that the plan has. Errors: out_of_memory.
  Result<Mesh> allocate() const;

  /// Writes the mesh.
  ///
  /// `set`: the set that the plan was made for, at any revision that collapses the same borders; the triangles are the
  /// same for all control points. The bounds hold only for the revision that the plan was made or updated for. The plan
  /// does not keep the set itself: a run on another set of equal shape (patch count, degrees and collapsed borders)
  /// writes that set's mesh, relative to that set's origin, for which nothing is proven.
  ///
  /// Errors: buffer_too_small, stale (another number of patches, other degrees, collapsed borders or loops),
  /// unsupported (a set without float Bernstein blocks), invalid_argument (views; a view of normals where vertices are
  /// shared everywhere; a view of quads if the plan has none), cancelled. Nothing is written on any error but
  /// cancelled.
  ///
  /// The bytes are the same for any number of threads, and on every instruction set that fuses multiply-adds; border
  /// positions are the same on all. Packed views (three floats per record) of large meshes are written past the caches
  /// unless execution.stores is plain. Allocates nothing after the first call.
  Status run(const PatchSet& set, const MeshViews& out, const Execution& execution = {}) const;

  /// Follows edits: sets new control points, proves the tolerances again, and moves the vertices of these patches.
  ///
  /// - `set`: the set of the plan. Patches that set_control_points() has edited since the last update are followed too.
  /// - `out`: the views of the mesh that run() has written; positions, and normals if wanted, are enough. They hold as
  ///   many vertices as capacity() says. Records of other patches are not touched, except vertices that welding takes
  ///   from edited patches.
  ///
  /// A patch keeps its segments as `spare` says; if any patch does not, or collapses other borders, the topology has
  /// changed. Borders stay joined as they were when the topology was last made: where edits move apart borders of the
  /// same bits, so is the mesh, and borders that edits bring together are joined by a new plan only. A topology that is
  /// made when borders have moved apart joins those that are the same bits then.
  ///
  /// The set and the views get the same bytes as from PatchSet::set_control_points() for each edit and run(), for any
  /// number of threads. The revision grows by one, unless there is no edit.
  ///
  /// Errors, with nothing written and the set unchanged:
  /// - buffer_too_small, count_mismatch (views of fewer or more vertices: of a mesh of another topology)
  /// - invalid_argument (views; index = the edit: no such patch, or one that an edit before names)
  /// - count_mismatch (points), stale (another set)
  /// - non_finite (index = the edit: a point is not finite, or does not fit the set's numbers relative to its origin)
  ///
  /// Errors after the set was edited:
  /// - invalid_argument (no mesh keeps the tolerances within the limits: as make()), out_of_memory. Nothing is written.
  /// - cancelled. Some patches may have their new control points, and some of them their new vertices.
  ///
  /// The plan is then that of the mesh before, and the next update, without edits too, makes up for this one.
  ///
  /// Memory: the first update of a patch gives its points memory of their own, if it shares them with other patches.
  /// Later updates allocate nothing if distances are the only tolerance and the topology is unchanged, except for a
  /// patch with a border that welding made a point.
  ///
  /// Time: what the edited patches take, unless the topology changes or `fewest` is set and a patch cannot keep its
  /// segments; both take up to the time of a new plan.
  Result<MeshChange> update(PatchSet& set, const PatchEdits& edits, const MeshViews& out,
                            const Execution& execution = {});
  /// Follows edits of spline surfaces: converts the patches that the moved control points act on, to the same bits as
  /// make_patch_set(), and updates as above.
  ///
  /// Errors, besides those above, with nothing written and the set unchanged (index = the edit): invalid_argument (the
  /// set's patches of this surface are not those of the spline; a surface that an edit before names; no such control
  /// point), count_mismatch (control points). Memory: the patches of these surfaces once more, kept for later calls.
  Result<MeshChange> update(PatchSet& set, std::span<const SurfaceEdits> edits, const MeshViews& out,
                            const Execution& execution = {});

  class [[gnu::visibility("hidden")]] Impl;

 private:
  friend struct ImplAccess;
  explicit Tessellation(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// Returns Mesh::parts by surfaces: one part for each run of triangles and quads whose patches come from one surface.
///
/// - `set`: the set that mesh.patches refers to, made of `model`.
///
/// Runs are counted in the order of the patches: the next triangle or quad is the one with the lower patch. A part has
/// the name of its surface in the model, or "surface 3" if that name is empty. It has the colour of the face that the
/// surface is, or else of the face's instance.
///
/// Errors: count_mismatch (not one patch per triangle and per quad), invalid_argument (no such patch in the set, or no
/// such surface in the model; index = the triangle or quad).
Result<std::vector<MeshPart>> parts_by_surface(const Mesh& mesh, const PatchSet& set, const Model& model);

}}  // namespace tessera::abi_0_1
#pragma GCC visibility pop
