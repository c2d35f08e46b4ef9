#pragma once
// Plans how each patch of a set is divided so that a tolerance is kept and neighbours meet.

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "block/patch_set_impl.h"
#include "parallel/workspaces.h"
#include "tess/bounds/cell_limits.h"
#include "tess/bounds/chord_blocks.h"
#include "tess/bounds/local_chord.h"
#include "tess/bounds/picture.h"
#include "tess/bounds/rounded_up.h"
#include "tess/cells/stitched_patch.h"
#include "tess/closing/closed_edges.h"
#include "tess/closing/edge_stops.h"
#include "tess/edges/edge_directions.h"
#include "tess/edges/shared_edges.h"
#include "tess/edges/weld.h"
#include "tess/plan/cut_shares.h"
#include "tess/trimmed/cut_patch.h"
#include "tessera/tessellation.h"

namespace tessera { inline namespace abi_0_1 {

inline constexpr std::uint64_t max_vertices = std::uint64_t{1} << 32;  ///< the limit of 32-bit indices

/// Returns the largest distance between a float vertex, relative to the set's origin, and the surface's point.
///
/// Each component is off by (m + n + 6) u times the largest |V|, twice that for rational patches: steps 1 to 4 of
/// kernel/sample/sample_kernel.inl.h.
double vertex_rounding(const BezierPatch& patch, const Vec3& origin);
/// vertex_rounding() by `size`, the largest |x|, |y| or |z| of the control points relative to the origin.
double vertex_rounding(int degree_u, int degree_v, bool rational, double size);

/// How each patch is divided, and where its vertices and triangles lie. Borders and corners are numbered, as in
/// VertexCopies, 4 * patch + side.
class CertifiedPlan {
 public:
  std::size_t patch_count() const { return divisions_.size(); }
  const Division& division(std::size_t patch) const { return divisions_[patch]; }
  std::span<const Division> divisions() const { return divisions_; }
  /// The patches that loops cut, by growing patch. Their divisions are empty but for the borders' segments.
  std::span<const CutPatch> cuts() const { return rare_ ? rare_->cuts : std::span<const CutPatch>(); }
  /// Cut patches without triangles, because their chords cross.
  std::span<const std::uint32_t> crossed() const { return rare_ ? rare_->crossed : std::span<const std::uint32_t>(); }
  /// Patches whose bounds exceed the limits, by growing patch.
  std::span<const std::uint32_t> beyond() const { return rare_ ? rare_->beyond : std::span<const std::uint32_t>(); }
  /// The vertices that faces share along edges; null if the set has no edges.
  const ClosedEdges* closed() const { return rare_ && rare_->closed ? &*rare_->closed : nullptr; }
  /// Whether another plan has the same triangles, by the numbers of their vertices.
  bool has_triangles_of(const CertifiedPlan& other) const;
  /// Whether a set has the loops that the plan was made for.
  bool has_trims_of(const PatchSet::Impl& set) const {
    return rare_ ? rare_->trims == set.trims : set.trims == nullptr;
  }
  std::span<const PatchSegments> segments() const { return segments_; }  ///< segments that each patch needs for itself
  std::size_t first_vertex(std::size_t patch) const { return first_vertex_[patch]; }
  std::size_t first_triangle(std::size_t patch) const { return first_triangle_[patch]; }
  MeshCapacity capacity() const { return {first_vertex_.back(), first_triangle_.back(), 0}; }
  /// Returns how many edges of the triangles lie on borders that no other border is joined to.
  std::size_t open_edges() const { return open_edges_; }
  /// In a mesh with quads, cells between inner points are quads, and first_strip() counts triangles without theirs.
  std::size_t first_quad(std::size_t patch) const { return first_quad_[patch]; }
  std::size_t first_strip(std::size_t patch) const { return first_triangle_[patch] - 2 * first_quad_[patch]; }
  std::span<const float> bounds() const { return bounds_; }
  std::span<const float> angles() const { return angles_; }  ///< empty if no angle was set
  std::span<const float> pixels() const { return pixels_; }  ///< empty if no pixels were set
  /// `[patch]`: 1 if its vertices come from the set's double control points, see F64Points; empty if no patch's do.
  /// Borders of one edge then have the same positions only after VertexCopies are made.
  std::span<const std::uint8_t> f64_patches() const {
    return rare_ ? rare_->f64_patches : std::span<const std::uint8_t>();
  }
  bool is_f64(std::size_t patch) const { return !f64_patches().empty() && f64_patches()[patch]; }
  /// Whether the mesh has positions in double; implies is_f64() of all patches.
  bool has_f64_positions() const { return has_f64_positions_; }

  /// Stores vertices that are copies of each other once. Ring vertices that a patch owns follow its inner points.
  void share(const VertexCopies& copies);
  bool shares_vertices() const { return !ring_sources_.empty(); }
  /// Returns the corner whose patch owns the vertex of a corner.
  std::uint32_t corner_owner(std::uint32_t corner) const {
    return shares_vertices() ? ring_sources_[corner].corner : corner;
  }
  bool owns_corner(std::size_t corner) const { return corner_owner(static_cast<std::uint32_t>(corner)) == corner; }
  /// Whether the patch owns the points inside a border.
  bool owns_border(std::size_t border) const {
    return !shares_vertices() || (ring_sources_[border].from == border && !ring_sources_[border].is_point);
  }
  /// Returns the vertex at point k = 0 .. rate of a border of a patch with an area, in the direction of the ring.
  std::size_t ring_vertex(std::uint32_t border, int k) const;

 private:
  friend class CertifiedPlanner;
  friend class PlanUpdate;
  /// Who owns the vertices of a border and of the corner at its start.
  struct RingSource {
    std::uint32_t corner;                     ///< the corner that owns the vertex at the start
    std::uint32_t from;                       ///< the border that owns the points inside
    bool reversed = false, is_point = false;  ///< a point: `from` is a corner
  };
  void lay_out();
  void set_f64_patches(std::span<const std::uint8_t> patches);
  /// A patch of an area without triangles: opposite borders are points, and the line between them is the border of
  /// another, or a point that another has.
  struct LinePatch {
    std::uint32_t patch;
    std::uint32_t holder;  ///< a patch with triangles on that line; no_id for points
  };
  std::span<const LinePatch> line_patches() const { return rare_ ? rare_->lines : std::span<const LinePatch>(); }
  void set_line_patches(std::vector<LinePatch> lines) {
    if (!lines.empty() && !rare_) rare_ = std::make_unique<Rare>();
    if (rare_) rare_->lines = std::move(lines);
  }
  /// Sets beyond(). `flags`: by patch.
  void set_beyond(std::span<const std::uint8_t> flags);
  /// Counts open_edges() of a mesh with cut patches. `edges`: those of the planner, after welding.
  void count_open_edges_beside_loops(const SharedEdges& edges);
  std::size_t owned_ring_count(std::size_t patch, std::uint32_t sides = 4) const;

  std::vector<PatchSegments> segments_;
  std::vector<Division> divisions_;
  /// `[patch]`, and the number of all at the end.
  std::vector<std::size_t> first_vertex_, first_triangle_, first_quad_;
  std::vector<float> bounds_, angles_, pixels_;
  /// Members that few plans have.
  struct Rare {
    std::vector<std::uint8_t> f64_patches;
    std::shared_ptr<const PatchTrims> trims;  ///< those of the set
    std::vector<CutPatch> cuts;
    std::vector<std::uint32_t> crossed, beyond;
    std::optional<ClosedEdges> closed;
    std::vector<LinePatch> lines;
  };
  std::unique_ptr<Rare> rare_;  ///< null if none of these are known of any patch
  std::uint32_t open_edges_ = 0;
  bool has_f64_positions_ = false;
  std::vector<std::uint8_t>
      straddles_;  ///< `[patch]`: 1 if its bounds hold for triangles across its middle too; empty if for none
  std::vector<RingSource> ring_sources_;  ///< `[border]`: itself if it owns its vertices; empty if nothing is shared
};

constexpr bool is_backward(std::uint32_t border) { return is_backward(all_sides[border % 4]); }

/// The limits to keep besides a distance, and how borders are joined.
struct PlannerOptions {
  WeldRules weld = {};
  /// `[patch]`: 1 if its vertices come from double control points; empty if no patch's do.
  std::vector<std::uint8_t> f64_patches = {};
  bool f64_positions = false;   ///< the mesh has positions in double; needs all f64_patches
  std::optional<double> angle;  ///< radians, above 0, at most pi / 2
  int angle_rate = 64;          ///< the least rate where the angle has no bound
  std::optional<Camera> camera;
  double pixels = 0;  ///< above 0 if there is a camera
  bool fewest = false;
  bool closes_edges = true;  ///< whether faces get the same vertices along the edges of shapes
  double max_gap = std::numeric_limits<double>::infinity();  ///< of edges that are closed
  bool keeps_bounds = false;  ///< keeps the bounds of angles, half a KiB per patch, for many plans of one planner
};

/// Segments that patches keep instead of the best ones, as long as they keep the tolerances and have at most (1 +
/// spare) times the cells of the best ones.
struct KeptSegments {
  std::span<const PatchSegments> segments = {};  ///< `[patch]`, or empty
  double spare = 0;
};

/// All that is found for a set before its tolerance is known: shapes, edges, welds and bounds.
class CertifiedPlanner {
 public:
  /// Makes a planner. The set must outlive it. Errors: cancelled, out_of_memory.
  static Result<CertifiedPlanner> make(const PatchSet::Impl& set, const PlannerOptions& options,
                                       const Execution& execution);

  /// Returns the shapes of the patches before welding.
  std::span<const PatchShape> shapes() const { return shapes_; }
  const Weld& weld() const { return weld_; }
  const SharedEdges& edges() const { return edges_; }  ///< after welding
  /// Whether the borders of each edge are the same bits in the set as it is now, after edits, but for welded ones.
  bool edges_hold() const { return edge_directions().hold(); }
  /// The share of the tolerance that the rounding of vertices from float control points may take. It costs up to a
  /// third more triangles, and doubles take five times as long.
  static constexpr double max_rounding = 0.25;
  /// Returns PlannerOptions::f64_patches of the patches where the rounding of vertices from float control points takes
  /// more than max_rounding, or all that pixels leave.
  std::vector<std::uint8_t> patches_that_need_f64(double tolerance) const;
  /// Whether the rounding of vertices leaves less than half of the tolerance.
  bool is_rough(double tolerance) const;
  /// Returns about the smallest tolerance that the vertices keep with max_triangles, to two digits; none if it is far
  /// above the rounding of the vertices.
  std::optional<double> nearest_tolerance(std::uint64_t max_triangles) const;
  /// Makes a plan. `tolerance`: the distance, infinite if there is no limit. Errors: invalid_argument (as for
  /// Tessellation::make), cancelled.
  Result<CertifiedPlan> plan(double tolerance, std::uint64_t max_triangles, const Execution& execution,
                             const KeptSegments& kept = {}) const;
  /// Returns the smallest tolerance 2^(k/128), for whole k, whose mesh has at most max_triangles, and at least 1e-6 of
  /// what one cell per patch keeps. Errors: invalid_argument (one cell per patch exceeds max_triangles), cancelled.
  Result<double> smallest_tolerance(std::uint64_t max_triangles, const Execution& execution) const;

 private:
  friend class PlanUpdate;
  /// Why a patch has no rates.
  enum class Failure : std::uint8_t {
    none,
    rough,         ///< the vertices alone exceed the tolerance
    rough_pixels,  ///< the vertices alone exceed the pixels
    wide,          ///< more segments than the limit
  };
  /// The segments that a patch needs for itself, and the limits that they keep.
  struct Choice {
    Failure failure = Failure::none;
    double cells = 0;  ///< the cells of uniform segments
    /// At most so many cells. This and the members below are set only if rates are limited to max_rate.
    PatchSegments segments;
    bool anywhere = false;  ///< see ProvenSegments
    double bound = 0, angle = 0, pixels = 0;
  };

  CertifiedPlanner(const PatchSet::Impl& set, const PlannerOptions& options)
      : set_(&set), options_(options), fit_error_(set.fit_error.distance), chords_(set, options.f64_positions) {}
  bool is_f64(std::size_t patch) const { return !options_.f64_patches.empty() && options_.f64_patches[patch]; }
  ChordBound chord(std::size_t patch) const { return chords_.chord(set_->slots[patch].block, set_->slots[patch].lane); }
  /// The demands on a plan.
  struct Request {
    double tolerance;     ///< the distance, infinite if there is no limit
    bool fewest = false;  ///< see TessellationOptions::fewest
    KeptSegments kept = {};
    /// A limit on the triangles of each cut patch, and for tolerances that messages propose.
    std::uint64_t max_triangles = std::numeric_limits<std::uint64_t>::max();
    double share = 1;      ///< the part of what the limits leave that cells may take
    double slack = 1;      ///< the factor by which the limits of a patch may be exceeded
    bool uniform = false;  ///< whether segments are of one length
    /// By cut patch: the part of the tolerance that it may take before edges are closed; empty: all of it.
    std::span<const double> cut_shares = {};
  };
  /// Makes a plan without a limit on its triangles in all.
  Result<CertifiedPlan> plan(const Request& request, const Execution& execution) const;
  /// Makes the plan with the fewer triangles, by fewest segments or by plain ones, without a limit on its triangles
  /// in all.
  Result<CertifiedPlan> leaner_plan(const Request& request, const Execution& execution) const;
  /// Finds edges, shapes, bounds and roundings.
  Status find_edges_and_bounds(const Execution& execution);
  /// Finds shapes, bounds and roundings of the patches of one block.
  void bound_block(std::size_t block);
  /// Returns the rounding of a patch's vertices before welding, once its block is bounded.
  double own_rounding(const BlockGroup& group, PatchSet::Slot slot) const;
  /// Adds the whole patches that give vertices to cut ones that need doubles.
  void add_givers_of_cut(std::vector<std::uint8_t>& patches) const;
  void find_edges_in_step();
  /// The share of an edge's range within which parameters count as one.
  double same_share(const Request& request) const;
  /// Finds the borders to weld, and adds the displacements to the roundings.
  void find_weld();
  Status bound_turning_and_picture(const Execution& execution);
  /// How the normal of a patch turns.
  struct NormalTurning {
    TurningBound bound;
    /// False where the surface's own normal has no bound beside a border that welding makes a point: the bound is then
    /// that of the patch with a pole there, and divides the patch, but proves nothing.
    bool is_proven = true;
  };
  NormalTurning turning_of(std::size_t patch) const;
  /// Bounds what the camera sees of the patches of one block; needs their roundings.
  void bound_pictures(std::size_t block);
  Choice choose(std::size_t patch, const Request& request, int most) const;
  /// Chooses for a patch that cannot keep its limits: within the least multiple of them, in powers of 2, that leaves
  /// room above its vertices and is kept.
  Choice choose_beyond(std::size_t patch, const Request& request) const;
  /// States the patches beyond their limits. Errors: invalid_argument (no patch keeps them).
  Status keep_beyond(const Request& request, std::span<const std::uint8_t> beyond, CertifiedPlan& plan) const;
  std::optional<Rates> rates_for(const CellLimits& limits, int most) const;
  /// Chooses rates and bounds of all patches.
  Status choose_rates(const Request& request, CertifiedPlan& plan, const Execution& execution) const;
  void set_segments(std::size_t patch, const ProvenSegments& proven, CertifiedPlan& plan) const;
  /// Chooses rates of one block's patches. They go to `choices` if there are any, otherwise to the plan.
  void choose_block(std::size_t block, const Request& request, std::span<SegmentChoices> choices, CertifiedPlan& plan,
                    std::span<std::uint8_t> beyond) const;
  /// Chooses rates and bounds, block by block, if a distance is the only limit.
  Status choose_by_distance(const Request& request, CertifiedPlan& plan, const Execution& execution) const;
  /// Replaces rates that keep the limits by segments with fewer cells, or by kept ones where possible.
  ProvenSegments settle(std::size_t patch, const CellLimits& limits, const ChordBound& chord, int min_rate,
                        const Request& request, Rates rates) const;
  /// Returns the kept segments where possible, else the best, if a distance is the only limit. `products`: those that
  /// the best ones come from; null if they come from none.
  ProvenSegments keep_by_distance(std::size_t patch, double distance, const KeptSegments& kept,
                                  const ChordBlocks::Products* products, const ProvenSegments& best) const;
  /// Adds segments to the choices and returns those with which the patches together have the fewest triangles.
  Result<std::vector<ProvenSegments>> find_fewest(double tolerance, std::vector<SegmentChoices> choices,
                                                  const Execution& execution) const;
  /// Returns the distance that a patch keeps by bounds of small pieces; infinite unless PlannerOptions::fewest.
  double local_distance(std::size_t patch, PatchSegments segments) const;
  Status refusal(Failure failure, std::size_t patch, const Request& request) const;
  std::string wanted(double tolerance) const;
  bool is_displaced(std::size_t patch) const { return !weld_.displacements.empty() && weld_.displacements[patch] > 0; }
  void divide(double tolerance, CertifiedPlan& plan) const;
  /// Gives triangles to patches without any, unless those of a neighbour show what is left of them.
  void keep_from_vanishing(CertifiedPlan& plan) const;
  /// Whether welding made a patch a point, and a neighbour has triangles there.
  bool is_welded_spot(std::size_t patch, const CertifiedPlan& plan) const;
  /// The room for the triangles of a cut patch, and for the slivers along its loops.
  struct CutRoom {
    double given = 0;  ///< the errors of its vertices and of the fit
    double tolerance = 0;
    TrimmedPatch limits;
  };
  /// What attempts to cut all patches share.
  struct Cutting {
    std::optional<CutShares> shares;  ///< once an attempt is made
    std::optional<EdgeStops> stops;   ///< those that patches are cut by, if edges are closed
    std::vector<double> excess;       ///< by cut patch
    Workspaces<CutPatchMaker> makers;
  };
  /// Finds what chords along edges must keep for the faces on both sides, as patches are divided now. Edges without a
  /// changed patch keep their stops. Marks the patches along edges whose stops change as changed, too.
  Status find_stops(std::span<const CutRoom> rooms, const CertifiedPlan& plan, std::optional<EdgeStops>& stops,
                    std::vector<std::uint8_t>& is_changed, const Request& request, const Execution& execution) const;
  /// Gives faces the same vertices along the edges of shapes.
  Status close_edges(const Request& request, CertifiedPlan& plan, const Execution& execution) const;
  /// `[4 * patch + side]`: whether triangles of two patches have the same border.
  std::vector<std::uint8_t> joined_borders(const CertifiedPlan& plan) const;
  bool is_cut(std::size_t patch) const { return set_->trims && set_->trims->is_cut[patch]; }
  /// Finds the sides of faces that loops cut, and keeps their patches from being divided as whole ones.
  void find_cut_faces();
  /// `share`: the part of the tolerance that the patch may take.
  CutRoom room_of(const CutPatch& cut, double share, const Request& request, const CertifiedPlan& plan) const;
  /// Returns the rooms of all cut patches, as patches are divided now. Errors: cancelled.
  Result<std::vector<CutRoom>> find_rooms(const Request& request, const CertifiedPlan& plan,
                                          const Execution& execution) const;
  /// Chooses the segments of the cut patches that are to be cut anew, for their shares of the room.
  void choose_cut(const Request& request, CutShares& shares, CertifiedPlan& plan) const;
  /// The facts that all patches of one pass are cut by. `is_shared`: by edge, whether two borders or more have it.
  struct CutPass {
    std::span<const CutRoom> rooms;  ///< by cut patch
    const EdgeStops* stops;          ///< null if no edges are closed
    std::span<const std::uint8_t> is_shared;
    const std::atomic<bool>* cancel;
  };
  std::vector<std::uint8_t> shared_edges() const;
  /// Cuts a patch, place `c` among the cuts, and sets its bounds. Returns the largest over its limit.
  double cut_patch(std::size_t c, const CutPass& pass, CutPatchMaker& maker, CertifiedPlan& plan) const;
  /// Chooses the segments of cut patches, divides all patches and cuts those that are due or changed, until every bound
  /// holds or no attempt helps. Errors: invalid_argument (more triangles than the limit), cancelled.
  Status divide_and_cut(const Request& request, CertifiedPlan& plan, Cutting& cutting,
                        const Execution& execution) const;
  /// Makes one attempt of it.
  Status cut_once(const Request& request, std::span<const std::uint8_t> is_shared, CertifiedPlan& plan,
                  Cutting& cutting, const Execution& execution) const;
  /// Sets the bounds of a patch that has been cut. Returns the largest over its limit.
  double bound_cut(const CutRoom& room, const CutPatch& cut, CertifiedPlan& plan) const;
  /// Refuses cut patches that have more triangles than the limit.
  Status check_triangles(const Request& request, const CertifiedPlan& plan) const;
  /// The error of a tolerance for which a cut patch takes more triangles than the limit.
  Status too_many(const Request& request, std::size_t patch) const;
  /// Finds the borders of whole patches along the sides of cut ones.
  void find_same_borders(CertifiedPlan& plan) const;
  /// Returns the distance of the triangle that crosses the middle of an odd border, for a patch whose even rate along
  /// it has a bound of halves.
  double straddling_distance(std::size_t patch, Side side, const CertifiedPlan& plan) const;
  /// Returns the directions of borders along their edges. The set must be as it was when the edges were found.
  EdgeDirections edge_directions() const;
  /// Returns for each border whether it runs against the leading border of its edge. Requires edges_hold().
  std::vector<std::uint8_t> borders_against() const;
  /// The shapes by which patches are divided and welded: cut ones have no area.
  std::span<const PatchShape> own_shapes() const { return drawn_.empty() ? shapes_ : drawn_; }
  std::span<const PatchShape> divided_shapes() const { return weld_.shapes.empty() ? own_shapes() : weld_.shapes; }

  const PatchSet::Impl* set_;
  PlannerOptions options_;
  SharedEdges edges_;
  double fit_error_;
  std::vector<PatchShape> shapes_, drawn_;  ///< drawn_: empty if no patch is cut
  std::vector<FaceSides> face_sides_;       ///< by region of the set's trims
  std::optional<EdgeRuns> runs_;            ///< if edges are closed
  std::vector<std::uint32_t> cut_faces_;    ///< by cut patch: into PatchEdges::faces, or no_id; empty without runs_
  std::vector<std::vector<std::uint32_t>> edges_in_step_;  ///< edges of `edges_` that should have as many segments
  Weld weld_;
  double largest_rounding_ = 0;    ///< the largest rounding of vertices before welding
  std::vector<double> roundings_;  ///< `[patch]`: the largest error of its vertices, by rounding or by welding
  ChordBlocks chords_;
  std::vector<NormalTurning> turnings_;     ///< `[patch]`, if PlannerOptions::keeps_bounds and there is an angle
  std::vector<ScreenSpaceBound> pictures_;  ///< `[patch]`, if there is a camera
};

}}  // namespace tessera::abi_0_1
