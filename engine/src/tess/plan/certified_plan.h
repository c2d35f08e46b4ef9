#pragma once
// How each patch of a set is divided so that a tolerance is kept and neighbours meet.

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "block/patch_set_impl.h"
#include "tess/bounds/cell_limits.h"
#include "tess/bounds/chord_blocks.h"
#include "tess/bounds/local_chord.h"
#include "tess/bounds/picture.h"
#include "tess/bounds/rounded_up.h"
#include "tess/edges/shared_edges.h"
#include "tess/edges/weld.h"
#include "tess/write/stitched_patch.h"
#include "tessera/tessellation.h"

namespace tessera::inline abi_0_1 {

/// The largest distance between a float vertex, relative to the set's origin, and the surface's point. Each term of a sum of
/// B_i B_j V_ij, or of B_i B_j w_ij V_ij and of B_i B_j w_ij, has gone through at most m + n + 6 roundings: of the packed
/// coefficient, of the weights, and of the sums (Higham, Accuracy and Stability of Numerical Algorithms, 2nd ed., sec. 3.1).
/// The terms' sizes add up to at most the largest |V|, and so they do for rational patches, over the sum of weights.
double vertex_rounding(const BezierPatch& patch, const Vec3& origin);
/// The same by `size`, the largest |x|, |y|, |z| of its control points relative to the origin.
double vertex_rounding(int degree_u, int degree_v, bool rational, double size);

/// How each patch is divided, and where its vertices and triangles lie. Borders and corners go by 4 * patch + side, as in
/// VertexCopies.
class CertifiedPlan {
 public:
  std::size_t patch_count() const { return divisions_.size(); }
  const Division& division(std::size_t patch) const { return divisions_[patch]; }
  std::span<const Division> divisions() const { return divisions_; }
  std::span<const PatchSegments> segments() const { return segments_; }  ///< what each patch needs for itself
  std::size_t first_vertex(std::size_t patch) const { return first_vertex_[patch]; }
  std::size_t first_triangle(std::size_t patch) const { return first_triangle_[patch]; }
  MeshCapacity capacity() const { return {first_vertex_.back(), first_triangle_.back(), 0}; }
  /// Cells between inner points may be quads; triangles are then counted without theirs.
  std::size_t first_quad(std::size_t patch) const { return first_quad_[patch]; }
  std::size_t first_strip(std::size_t patch) const { return first_triangle_[patch] - 2 * first_quad_[patch]; }
  MeshCapacity quad_capacity() const { return {first_vertex_.back(), first_strip(patch_count()), first_quad_.back()}; }
  std::span<const float> bounds() const { return bounds_; }
  std::span<const float> angles() const { return angles_; }  ///< empty if none was asked for
  std::span<const float> pixels() const { return pixels_; }  ///< the same
  /// Whether vertices come from the set's double control points: see F64Points. Borders that are one edge then have the same
  /// positions once VertexCopies are made.
  bool is_f64() const { return is_f64_; }
  bool has_f64_positions() const {
    return has_f64_positions_;
  }  ///< the mesh's positions are in double; is_f64() as well

  /// Stores vertices that are copies once. Those of the ring that a patch owns follow its inner points.
  void share(const VertexCopies& copies);
  bool shares_vertices() const { return !corner_sources_.empty(); }
  bool owns_corner(std::size_t corner) const { return !shares_vertices() || corner_sources_[corner] == corner; }
  /// The points inside a border.
  bool owns_border(std::size_t border) const {
    return !shares_vertices() || (border_sources_[border].from == border && !border_sources_[border].is_point);
  }
  /// The vertex at point k of a border of a patch with an area, as the ring runs, k = 0 .. rate.
  std::size_t ring_vertex(std::uint32_t border, int k) const;

 private:
  friend class CertifiedPlanner;
  struct BorderSource {
    std::uint32_t from;
    bool reversed = false, is_point = false;  ///< a point: `from` is a corner
  };
  void lay_out();
  std::size_t owned_ring_count(std::size_t patch, std::uint32_t sides = 4) const;

  std::vector<PatchSegments> segments_;
  std::vector<Division> divisions_;
  std::vector<std::size_t> first_vertex_, first_triangle_, first_quad_;  ///< of each patch, and the number of all
  std::vector<float> bounds_, angles_, pixels_;
  bool is_f64_ = false, has_f64_positions_ = false;
  std::vector<std::uint8_t> straddles_;  ///< patches whose bound holds wherever triangles lie; empty if there are none
  std::vector<std::uint32_t>
      corner_sources_;  ///< of each corner, itself if it owns its vertex; empty if nothing is shared
  std::vector<BorderSource> border_sources_;
};

constexpr bool is_backward(std::uint32_t border) { return is_backward(all_sides[border % 4]); }

/// What is to be kept beside a distance, and how borders are joined.
struct PlannerOptions {
  double weld = 0;              ///< finite, at least 0
  bool f64 = false;             ///< vertices come from double control points
  bool f64_positions = false;   ///< and are positions in double
  std::optional<double> angle;  ///< radians, above 0, at most pi / 2
  int angle_rate = 64;          ///< where the angle has no bound
  std::optional<Camera> camera;
  double pixels = 0;  ///< above 0 if there is a camera
  bool fewest = false;
};

/// Segments that patches keep, rather than take others, where they keep the tolerances and have at most (1 + spare) times
/// the cells of the best.
struct KeptSegments {
  std::span<const PatchSegments> segments = {};  ///< of each patch, or none
  double spare = 0;
};

/// What is known of a set before a tolerance is.
class [[gnu::visibility("hidden")]] CertifiedPlanner {
 public:
  /// Errors: cancelled, out_of_memory. The set must outlive the planner.
  static Result<CertifiedPlanner> make(const PatchSet::Impl& set, const PlannerOptions& options,
                                       const Execution& execution);

  /// Before welding.
  std::span<const PatchShape> shapes() const { return shapes_; }
  const Weld& weld() const { return weld_; }
  const SharedEdges& edges() const { return edges_; }  ///< welded
  /// Whether the rounding of vertices that come from float control points takes more than an eighth of the tolerance, or
  /// all that pixels leave.
  bool needs_f64(double tolerance) const;
  /// Whether the rounding of vertices leaves less than half of the tolerance.
  bool is_rough(double tolerance) const;
  /// About the smallest tolerance that the vertices keep with so many triangles, to two digits; none where it is far above
  /// their rounding.
  std::optional<double> nearest_tolerance(std::uint64_t max_triangles) const;
  /// `tolerance`: the distance, infinite if any will do. Errors: invalid_argument, as CertifiedTessellation::make says;
  /// cancelled.
  Result<CertifiedPlan> plan(double tolerance, std::uint64_t max_triangles, const Execution& execution,
                             const KeptSegments& kept = {}) const;
  /// The smallest tolerance, within 1 percent, whose mesh has at most so many triangles. Errors: invalid_argument (not
  /// even one cell a patch keeps the budget).
  Result<double> smallest_tolerance(std::uint64_t max_triangles, const Execution& execution) const;

 private:
  /// Why a patch has no rates.
  enum class Failure : std::uint8_t {
    none,
    rough,         ///< vertices alone are further away than allowed
    rough_pixels,  ///< the same in the picture
    wide,          ///< more segments than allowed
  };
  /// What a patch needs for itself, and what that keeps.
  struct Choice {
    Failure failure = Failure::none;
    double cells = 0;        ///< of uniform segments
    PatchSegments segments;  ///< these or fewer; like the rest, if the rates allowed are at most max_rate
    double bound = 0, angle = 0, pixels = 0;
  };

  CertifiedPlanner(const PatchSet::Impl& set, const PlannerOptions& options)
      : set_(&set), options_(options), fit_error_(set.fit_error.distance), chords_(set, options.f64_positions) {}
  ChordBound chord(std::size_t patch) const { return chords_.chord(set_->slots[patch].block, set_->slots[patch].lane); }
  /// What is wanted of a plan.
  struct Request {
    double tolerance;     ///< the distance, infinite if any will do
    bool fewest = false;  ///< segments in halves and such are looked for
    KeptSegments kept = {};
    std::uint64_t max_triangles = std::numeric_limits<std::uint64_t>::max();  ///< of what a refusal offers
  };
  /// However many triangles it takes.
  Result<CertifiedPlan> plan(const Request& request, const Execution& execution) const;
  Status bound_turning_and_picture(const PatchSet::Impl& set, const Execution& execution);
  Choice choose(std::size_t patch, const Request& request, int most) const;
  std::optional<Rates> rates_for(const CellLimits& limits, int most) const;
  /// Rates and bounds of all patches.
  Status choose_rates(const Request& request, CertifiedPlan& plan, const Execution& execution) const;
  /// The same where nothing but a distance is to be kept, block by block.
  Status choose_by_distance(const Request& request, CertifiedPlan& plan, const Execution& execution) const;
  /// Takes the fewest cells, if these are looked for, or the kept ones in the place of rates that keep the limits.
  ProvenSegments settle(std::size_t patch, const CellLimits& limits, const ChordBound& chord, int min_rate,
                        const Request& request, Rates rates) const;
  /// The kept segments rather than the best, where there is nothing but a distance.
  ProvenSegments keep_by_distance(std::size_t patch, double distance, const KeptSegments& kept,
                                  ChordBlocks::Products& products, const ProvenSegments& best) const;
  /// Those, or others, with which the patches together have the fewest triangles.
  Result<std::vector<ProvenSegments>> find_fewest(double tolerance, std::vector<SegmentChoices> choices,
                                                  const Execution& execution) const;
  /// What a patch keeps by bounds of small pieces; infinite where plans don't look for the fewest triangles.
  double local_distance(std::size_t patch, PatchSegments segments) const;
  Status refusal(Failure failure, std::size_t patch, const Request& request) const;
  std::string wanted(double tolerance) const;
  void divide(double tolerance, CertifiedPlan& plan) const;
  /// Whether a border may have an odd rate where its patch, whose bound is that of halves, has an even one: then the
  /// patch's bound is that of the triangle which straddles the middle there, too.
  bool may_straddle(std::size_t patch, Side side, const std::array<Segments, 4>& borders, double tolerance,
                    CertifiedPlan& plan) const;
  /// Of each border, whether it runs against the first one of its edge.
  std::vector<std::uint8_t> borders_against() const;
  std::span<const PatchShape> divided_shapes() const { return weld_.shapes.empty() ? shapes_ : weld_.shapes; }

  const PatchSet::Impl* set_;
  PlannerOptions options_;
  SharedEdges edges_;
  double fit_error_;
  std::vector<PatchShape> shapes_;
  Weld weld_;
  double largest_rounding_ = 0;    ///< of vertices before welding
  std::vector<double> roundings_;  ///< of each patch's vertices, or by how much its vertices are off when welded
  ChordBlocks chords_;
  std::vector<TurningBound> turnings_;      ///< if there is an angle
  std::vector<ScreenSpaceBound> pictures_;  ///< if there is a camera
};

}  // namespace tessera::inline abi_0_1
