#pragma once
// Turns patches into triangles and quads: at uniform rates, or so that a tolerance in length, angle or pixels provably
// holds without cracks. Meshes follow edits of control points.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "tessera/evaluate.h"
#include "tessera/execution.h"
#include "tessera/geometry.h"
#include "tessera/mesh.h"
#include "tessera/nurbs_surface.h"
#include "tessera/patch_set.h"
#include "tessera/status.h"
#include "tessera/tessellation_options.h"

#pragma GCC visibility push(default)
namespace tessera { inline namespace abi_0_1 {

struct Model;

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

/// A vertex of a mesh where the loop of a face runs along an edge of its shape.
struct EdgeVertex {
  std::uint32_t edge = 0;    ///< counted as in Tessellation::edge_gaps()
  std::uint32_t use = 0;     ///< a number of the coedge, which grows with faces, loops and curves
  std::uint32_t patch = 0;   ///< of the coedge's face
  std::uint32_t vertex = 0;  ///< of the mesh
  double s = 0;              ///< the edge's parameter there; the same for all faces along the edge
};

/// Sets the control points of a set's patches without a plan: converts those that the moved points act on, to the same
/// bits as make_patch_set(). Plans, grids and scenes of the set follow as after PatchSet::set_control_points().
///
/// Errors, with the set unchanged (index = the edit): invalid_argument (the set's patches of this surface are not those
/// of the spline; a surface that an edit before names; no such control point), count_mismatch (control points),
/// non_finite (a point), cancelled, out_of_memory.
///
/// The revision grows by one, unless no patch changes.
Status set_control_points(PatchSet& set, std::span<const SurfaceEdits> edits, const Execution& execution = {});

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
///   auto mesh = plan->run(set);
///   auto change = plan->update(set, {patches, points}, *mesh);  // each frame
///
/// - Bounds: the bound of each patch is proven, in both directions, rounding and welds included.
/// - Decisions are local: the division and the vertices of a patch depend on the patch, the options, the set's origin
///   and the patches that it touches.
/// - No cracks: patches that meet have the same vertices along their border, to the bit. All faces along an edge of a
///   shape do too, so the mesh of a closed shell has no open edges at any tolerance; see gap().
/// - Trimming loops: the mesh shows what an odd number of them encloses, with the same bounds.
///
/// share/doc/tessera/meshes.md states each of these with its exceptions, the rules of welding and the sources of the
/// bounds.
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
/// Memory: with rates 24 bytes per patch; with tolerances 1 KiB per patch to make and 256 bytes per patch to keep, more
/// with angles, pixels and edits.
class Tessellation {
 public:
  /// Makes a plan.
  ///
  /// Errors:
  /// - invalid_argument (neither rates nor a tolerance of any kind, or both; a rate out of range; a tolerance that is
  ///   not above 0, index = the surface if it is that of one)
  /// - count_mismatch (not one tolerance for each surface)
  /// - invalid_argument (tolerances that no patch keeps, see patches_beyond_tolerance(); the message names about the
  ///   smallest one that all keep, or how many triangles it takes)
  /// - invalid_argument (a view without a picture; a weld, a crease angle or `spare` out of range)
  /// - invalid_argument (more triangles or vertices than the limits; the message says how many triangles the mesh
  ///   takes)
  /// - invalid_argument (max_triangles below what one cell per patch takes)
  /// - unsupported (the set has no float Bernstein blocks; it has cut patches, and rates or a border tolerance are
  ///   wanted; it has edges that close, and a border tolerance is wanted)
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
  /// `set`: the set that the plan was made for, wherever it was moved, at any revision that collapses the same borders;
  /// the triangles are the same for all control points. The bounds hold only for the revision that the plan was made or
  /// updated for.
  ///
  /// Errors: buffer_too_small, stale (another set; other collapsed borders), invalid_argument (views; a view of normals
  /// where vertices are shared everywhere; a view of quads if the plan has none), cancelled. Nothing is written on any
  /// error but cancelled.
  ///
  /// The bytes are the same for any number of threads, and on every instruction set that fuses multiply-adds; border
  /// positions are the same on all. Packed views (three floats per record) of large meshes are written past the caches
  /// unless execution.stores is plain. Allocates nothing after the first call.
  Status run(const PatchSet& set, const MeshViews& out, const Execution& execution = {}) const;

  /// Allocates and writes the mesh in one call. Errors: those of allocate(), and as above.
  Result<Mesh> run(const PatchSet& set) const;

  /// Takes the view that the next update plans for, with or without edits. The plan, its bounds and what run() writes
  /// stay those of the view before until then. Errors, with nothing changed: invalid_argument (a view without a
  /// picture; the plan has no tolerance in pixels).
  ///
  ///   plan->set_view(camera);  // each frame
  ///   auto change = plan->update(set, {}, mesh);
  Status set_view(const View& view);
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
  /// segments; both take up to the time of a new plan. A new view takes about half of that, but all of it with cut
  /// patches or edges of shapes.
  Result<MeshChange> update(PatchSet& set, const PatchEdits& edits, const MeshViews& out,
                            const Execution& execution = {});
  /// Follows a new view, and the edits that the set has had since the last update. Errors: as above.
  Result<MeshChange> update(PatchSet& set, const MeshViews& out, const Execution& execution = {}) {
    return update(set, PatchEdits{}, out, execution);
  }
  /// Follows edits as above, and replaces `mesh`, which run() or an update has written, where the topology has
  /// changed. Errors: those above, and those of run(): call that then.
  Result<MeshChange> update(PatchSet& set, const PatchEdits& edits, Mesh& mesh, const Execution& execution = {});
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

/// Returns Tessellation::bound() of the patches that the view of a plan of pixels sees, those whose pixel_bounds() are
/// above 0. Without pixels it is bound().
double seen_bound(const Tessellation& plan);

/// Returns the vertices along the edges of shapes, by edges, then uses, then growing s: each use of a closed edge has
/// vertices at the same parameters, whose positions are the same bits. Where patches of one face meet, each has a
/// vertex at that parameter, unless the mesh shares vertices. A degenerate edge has one vertex, at both ends.
///
/// Empty unless Joining::edge_vertices is set. Edges that max_gap leaves open, or that loops leave in part, may have
/// fewer vertices in one face than in another. Errors: out_of_memory. Memory: 24 bytes per vertex, kept by the plan.
Result<std::vector<EdgeVertex>> edge_vertices(const Tessellation& plan);

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
