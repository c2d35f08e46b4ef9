#pragma once
// Patches to triangles: at uniform rates, or so that a tolerance in length, angle or pixels provably holds without
// cracks; and meshes that follow edits of control points.

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
#include "tessera/patch_set.h"
#include "tessera/status.h"

#pragma GCC visibility push(default)
namespace tessera::inline abi_0_1 {

struct Model;

/// How finely patches are divided.
struct TessellationOptions {
  int rate_u = 8;               ///< segments along u of every patch, 1 to 4096
  int rate_v = 8;               ///< segments along v
  std::optional<Isa> isa = {};  ///< default_isa() if empty
};

/// Uniform tessellation: every patch at the same rates. Layout of the vertices: `[patch][iu][iv]`, so vertex
/// (patch * (rate_u + 1) + iu) * (rate_v + 1) + iv. Border vertices are duplicated, one a patch; where two patches share
/// the border's control points and run at equal rates, they are the same bits. Triangles that collapse at a pole are left out.
class TessellationPlan {
 public:
  /// Errors: invalid_argument (a rate out of range, counts that overflow 32-bit indices), isa_unavailable, unsupported
  /// (the set has no float Bernstein blocks). Memory: 24 bytes a patch.
  static Result<TessellationPlan> make(const PatchSet& set, const TessellationOptions& options = {});

  TessellationPlan(TessellationPlan&&) noexcept;
  TessellationPlan& operator=(TessellationPlan&&) noexcept;
  ~TessellationPlan();

  MeshCapacity capacity() const;  ///< exact, of triangles alone
  /// The same with quads: cells that are whole are quads, those at poles stay triangles.
  MeshCapacity quad_capacity() const;
  int rate_u() const;  ///< segments along u of every patch
  int rate_v() const;  ///< segments along v
  /// A mesh of the right size with all attributes, of triangles.
  Result<Mesh> allocate() const;
  /// The same for quads, and for triangles where there are none.
  Result<Mesh> allocate_quads() const;
  /// Writes the mesh, with quads if there is a view of them. `set` is the one that the plan was made for, at any revision
  /// that collapses the same edges.
  /// Errors: buffer_too_small, stale, invalid_argument, cancelled. Nothing is written on any but cancelled.
  /// The same bytes for any number of threads. Allocates nothing after the first call.
  Status run(const PatchSet& set, const MeshViews& out, const Execution& execution = {}) const;

  class [[gnu::visibility("hidden")]] Impl;

 private:
  explicit TessellationPlan(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// Mesh::parts by surfaces: a part for each run of triangles and quads whose patches come from one surface, with its name in
/// the model ("surface 3" if it has none); they are gone through together, always the next one of the lower patch. `set` is
/// the one of mesh.patches, made of `model`. Errors: count_mismatch (not one patch a triangle and a quad), invalid_argument
/// (no such patch in the set, or surface in the model; index = the triangle or quad).
Result<std::vector<MeshPart>> parts_by_surface(const Mesh& mesh, const PatchSet& set, const Model& model);

/// A picture of width x height square pixels, its middle in the direction of the target.
struct View {
  Vec3 eye, target;           ///< where the camera stands, and what it looks at
  Vec3 up{0, 0, 1};           ///< which way is up in the picture; another is taken where this is the direction of sight
  bool orthographic = false;  ///< parallel rays; else they meet in the eye
  double field_of_view = 40 * std::numbers::pi / 180;  ///< across the shorter side, radians, above 0 and below pi
  double extent = 1;               ///< orthographic: how much the shorter side shows, in the model's lengths
  int width = 1280, height = 800;  ///< of the picture, in pixels
  /// In perspective, what is less deep than this in front of the eye is not seen. 0: a thousandth of the target's distance.
  double near_distance = 0;
};

/// How far mesh and surfaces may lie apart in a picture: every point of either that is seen lies within so many pixels of
/// one of the other; silhouettes too. Along the rays it says nothing: an angle makes up for that in shading. Patches of
/// which nothing is in the frame are not divided for it. Those that come nearer to the eye than the view's near distance,
/// or pass behind it, are kept by their distance in space at the least depth at which anything of them is seen: so a
/// camera may stand inside the model, and a patch that it all but touches takes many triangles.
struct PixelTolerance {
  double pixels = 0.5;  ///< above 0
  View view;            ///< the camera
};

/// At least one of tolerance, angle, pixels and smallest.
struct CertifiedOptions {
  /// The largest distance between surfaces and mesh, in the model's lengths, above 0: every point of either lies within
  /// it of the other.
  std::optional<double> tolerance = {};
  /// The tolerance is a share of the size of the set's box instead, its diagonal.
  bool relative = false;
  /// The largest angle by which the surface's normal turns within a triangle, radians, above 0, at most pi / 2: any two of
  /// its normals over the triangle's parameters lie within it, and so does the mesh's shading, its vertices' normals mixed.
  /// (Flat triangles' own normals are another matter: those of needles may look anywhere.) Where the normal has no direction,
  /// at a cusp or at a corner with parallel tangents, there is no such bound, and nearly none where it turns at a rate of
  /// more than 32 radians over a patch: such a patch gets at least angle_rate segments along each parameter instead and
  /// counts in patches_without_angle(). Poles have bounds.
  std::optional<double> angle = {};
  int angle_rate = 64;                        ///< 1 to 4096
  std::optional<PixelTolerance> pixels = {};  ///< a tolerance in a camera's picture
  /// Borders that lie within this length of each other are joined: 0 to a twentieth of the set's size; 0 joins those of the
  /// same bits alone. About
  /// 1e-6 of the set's size suits files whose neighbours differ by rounding. It should stay below what the smallest patch
  /// measures: thinner ones lose their area.
  double weld = 0;
  /// Patches that meet: where their normals lie within this angle of each other all along a border, radians, 0 to pi, and
  /// look the same way, they get one normal a vertex, that of the patch that comes first; so does a pole all around. Borders
  /// where they do not are creases, with a normal for each patch. 0.01 takes in joins that are G1 but for rounding. It is
  /// found out by the normals of the mesh when the plan is made, and stays. (The angle that is proven, see above, is that
  /// of each patch's own normals.) Without it each patch has its own normals.
  std::optional<double> crease_angle = {};
  /// Patches that meet share the vertices of their border by index, and a pole is one vertex: with a crease angle where
  /// they share normals; without one everywhere, and then there are no normals. A shared vertex counts to the patch that
  /// comes first: its parameters are those of that patch. Without it each patch has vertices of its own, of the same bits.
  bool share_vertices = false;
  /// More triangles than this are refused.
  std::uint64_t max_triangles = std::uint64_t{1} << 30;
  /// The tolerance is not given but found: the smallest, within 1 percent, for which max_triangles are enough. Angle and
  /// pixels are kept as well.
  bool smallest = false;
  /// Fewer triangles for more time: rates that bounds of many small pieces of each patch prove, where those of its halves ask
  /// for more; and where a patch bends unevenly, segments of their own in the halves of its parameters, and of its borders
  /// with the neighbours'; and, of those that will do, the ones that suit the neighbours (not beside an angle or pixels). It
  /// saves a twentieth to a third, most on rational patches and on those that bend along u in one place and along v in
  /// another, and never adds any. Takes 15 to 200 us a bicubic patch, some hundred times what a plan takes
  /// without (many seconds for a budget of triangles, which tries many): for meshes that are drawn, stored or updated often.
  bool fewest = false;
  std::optional<Isa> isa = {};  ///< default_isa() if empty
  /// Double: the mesh has positions in double as well, in the model's coordinates, and bounds are those of the mesh at these.
  /// For parts so far apart, and tolerances so small, that float does not keep them. All vertices and normals then come from
  /// the set's double control points, at about 1 us a vertex. Borders are one edge where their float control points are the
  /// same bits and those in double lie within 2^-20 of the border's size of each other; others are welded within 2^-50 of the
  /// largest coordinate, a few units in the last place.
  Precision precision = Precision::single_precision;
};

/// A mesh of the fewest cells of one size that keep the tolerance, patch by patch. The bound of a patch is proven. It is the
/// sum of a bound on the chords, the rounding of float vertices and the set's fit error. The chords are bounded by the second
/// derivatives of the patch (Filip, Magedson, Markot 1986), those of a rational patch in homogeneous form or by exact
/// numerators: a cylinder takes as many triangles at any height. Scaled sweeps rho(v) E(u) + T(v), as surfaces of revolution,
/// extrusions and cones are, need no bound on the mixed derivative. A flat convex quadrilateral takes two triangles.
///
/// Vertices are sums of floats, in SIMD, unless the rounding of these sums takes more than an eighth of the tolerance, or
/// all that pixels leave: parts far from each other beside a small tolerance. Then all vertices are sums of doubles, from the
/// set's double control points, rounded once to float: off by half a unit in the last place of a position relative to the
/// set's origin. They take several times as long and never go past the caches. Borders that were one edge when the plan was made
/// keep one border's vertices in later revisions, as welded ones do.
///
/// Without cracks: borders of patches whose packed control points are the same bits, in either direction, run at one
/// rate, and their vertices are the same bits in both patches. Each patch has an inner grid at rates of its own and strips of
/// triangles between that and its borders. A collapsed border is one point, and no triangle stands on it.
///
/// Welding: a border that is no other's by its bits is joined to the nearest one within the tolerance, in either
/// direction, of any degree: polynomial or rational, their points at equal parameters lie that near, by their control
/// points raised to one degree. (Rational curves of one shape whose parameters run at different speeds are not joined, nor
/// one long border to two short ones.) Its vertices become the other's, corners of joined borders become one corner's,
/// and borders whose control points lie in a box of at most the tolerance become points, as collapsed ones are. How far
/// vertices are moved is part of the bounds.
///
/// Layout of the vertices, patch after patch: first_vertex(k) + (iu - 1) * (rates v - 1) + iv - 1 for the inner points,
/// then the border points counter-clockwise from (0,0), each corner once, but for shared ones that count to another patch.
/// Immutable. Threads: any number of const calls. Memory: to make one 1 KiB a patch, to keep it 256 bytes; and about
/// 512 KiB at most that a process keeps of what small plans share.
class CertifiedTessellation {
 public:
  /// Errors: invalid_argument (no tolerance of any kind, or one that is not above 0; one that a patch's rounding, welding or
  /// the fit error exceeds already, or nearly: the message names about the smallest that has a plan; a view without a
  /// picture; a weld or a crease angle out of range; more triangles or vertices than allowed, or more than 4096 segments along
  /// a parameter: the message says how many triangles it takes; fewer triangles than one cell a patch takes), unsupported
  /// (the set has no float Bernstein blocks), isa_unavailable, cancelled.
  static Result<CertifiedTessellation> make(const PatchSet& set, const CertifiedOptions& options,
                                            const Execution& execution = {});

  CertifiedTessellation(CertifiedTessellation&&) noexcept;
  CertifiedTessellation& operator=(CertifiedTessellation&&) noexcept;
  ~CertifiedTessellation();

  /// What the mesh is proven to keep: the largest of bounds(). At most the tolerance. Of the revision that the plan was
  /// made for.
  double bound() const;
  /// Whether that is proven; false where the set's fit error is only sampled.
  bool certified() const;
  /// The same of each patch.
  std::span<const float> bounds() const;
  /// The angle that is proven, radians: the largest of those patches that have a bound. 0 if none was asked for.
  double angle() const;
  std::size_t patches_without_angle() const;  ///< those that have angle_rate segments instead of a bound
  /// The same of each patch, infinite where there is none; empty if none was asked for.
  std::span<const float> angles() const;
  /// What is proven in the picture, in pixels. 0 if it was not asked for.
  double pixels() const;
  /// The same of each patch, 0 where nothing is seen; empty if it was not asked for.
  std::span<const float> pixel_bounds() const;
  /// Borders that take the vertices of others, and those made points: joined by welding, not by their bits.
  std::size_t welded_borders() const;
  MeshCapacity capacity() const;  ///< exact, of triangles alone
  /// The same with quads: as many as there are cells that no strip belongs to, none where they are all in strips. A quad's
  /// corners are those of a box of the patch's parameters, in which all of its triangles lie: whatever is proven of the
  /// mesh holds for both, by either diagonal.
  MeshCapacity quad_capacity() const;
  /// A mesh of the right size with all attributes that there are, of triangles.
  Result<Mesh> allocate() const;
  /// The same for quads and the triangles of strips.
  Result<Mesh> allocate_quads() const;
  /// Writes the mesh of the set that the plan was made for, with quads if there is a view of them, at any revision: the same
  /// triangles, whatever the control
  /// points (the bounds hold for the plan's own revision). Errors: buffer_too_small, stale (another number of patches,
  /// other degrees or collapsed borders), invalid_argument (views; normals of vertices that are shared everywhere),
  /// cancelled. Nothing is written on any but cancelled. The same
  /// bytes for any number of threads, and on every instruction set that fuses multiply-adds; border positions on all.
  /// Packed views (three floats a record) of large meshes are written past the caches unless execution.stores is plain.
  Status run(const PatchSet& set, const MeshViews& out, const Execution& execution = {}) const;

  /// The plan for the set as it is now, by the options of this one: bounds, edges and welds are found anew, rates change
  /// only where they must. A patch keeps its own as long as these keep the tolerances and have at most (1 + spare) times
  /// the cells of the best; `spare` is at least 0. (All give way where triangles run out.) Errors: as make(); stale
  /// (another number of patches).
  Result<CertifiedTessellation> retessellate(const PatchSet& set, double spare = 0.25,
                                             const Execution& execution = {}) const;
  /// How many patches are divided, or joined to others, otherwise than in another plan for the set. Where there is none, a
  /// mesh of the one has the same triangles and vertices as one of the other.
  std::size_t divided_otherwise(const CertifiedTessellation& other) const;

  class [[gnu::visibility("hidden")]] Impl;

 private:
  friend struct ImplAccess;
  explicit CertifiedTessellation(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// A certified plan and the memory for updates of its mesh, so that repeated ones allocate nothing. An animated model costs
/// what the evaluation of its touched patches costs: triangles stay as they are. Threads: one call at a time.
///
///   auto update = MeshUpdate::make(set, std::move(plan));   // once plan.run(set, mesh.views()) has written the mesh
///   update->run(set, {patches, points}, mesh.views());      // each frame
///   if (update->restate(set).ok() && update->unproven() > 0)
///     if (auto changed = update->retessellate(set); changed && *changed > 0)
///       mesh = ...                                          // update->plan().allocate() and run()
class MeshUpdate {
 public:
  /// Takes over a plan of the set as it is. Errors: stale (another revision of the set, or number of patches);
  /// out_of_memory. Memory: 256 bytes a patch, those of the plan among them.
  static Result<MeshUpdate> make(const PatchSet& set, CertifiedTessellation plan);

  MeshUpdate(MeshUpdate&&) noexcept;
  MeshUpdate& operator=(MeshUpdate&&) noexcept;
  ~MeshUpdate();

  const CertifiedTessellation& plan() const;  ///< that of the mesh as it is now

  /// PatchSet::set_control_points() for each edit, and then the positions and normals of these patches alone: each task
  /// packs the patches that it evaluates while they are in its cache. `out` are the views of the mesh that the plan has
  /// written; positions, and normals if wanted, are enough. Records of other patches are not touched, but for vertices
  /// that welding takes from touched ones. The same bytes in the set and in the views as by those calls and by
  /// CertifiedTessellation::run(), for any number of threads. The revision grows by one, unless there is no edit.
  /// A patch's first update gives its points memory of their own, if it shares it with other patches; the next ones
  /// allocate nothing, but for a patch with a border that welding made a point.
  /// Where borders of the same bits are moved apart, so is the mesh; retessellate() finds what still meets.
  /// Errors, with nothing written: those of the views (buffer_too_small, invalid_argument); stale (the set was edited by
  /// other means; or index = the edit: other collapsed borders than in the plan); invalid_argument (index = the edit: no
  /// such patch, or one that an edit before names); count_mismatch (points); non_finite (index = the edit: a point is
  /// not finite, or does not fit the set's numbers relative to its origin). cancelled: each patch then has its new control
  /// points and its new vertices, or neither.
  Status run(PatchSet& set, const PatchEdits& edits, const MeshViews& out, const Execution& execution = {});

  /// Proves anew how far the mesh lies from the patches that were touched since the last call: about a quarter of what
  /// an update of theirs costs, but for plans of the fewest triangles, up to 110 us a bicubic patch; what such a plan has proven,
  /// one patch in a hundred is not known to keep, by up to 6%. Distances alone: angles and pixels are proven by a plan, and
  /// count as not proven for patches that were touched. Allocates nothing. Errors: stale (the set was edited by other
  /// means), cancelled.
  Status restate(const PatchSet& set, const Execution& execution = {});
  /// How far mesh and patches lie apart at most, as of the last restate(); at first the plan's bounds().
  std::span<const float> bounds() const;
  double bound() const;  ///< the largest
  /// How many patches their rates no longer serve: whose bound is above the plan's tolerance, or of whose angle or pixels
  /// nothing is known any more. As of the last restate().
  std::size_t unproven() const;

  /// Takes CertifiedTessellation::retessellate() of the plan in its place. How many patches are divided otherwise: if none,
  /// the mesh stays as it is; else it is another one, for plan().allocate() or capacity() and run(). All of them, if the
  /// set was edited by other means: then run() is due in any case. Errors: as there; the plan stays then.
  Result<std::size_t> retessellate(const PatchSet& set, double spare = 0.25, const Execution& execution = {});

 private:
  class [[gnu::visibility("hidden")]] Impl;
  explicit MeshUpdate(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace tessera::inline abi_0_1
#pragma GCC visibility pop
