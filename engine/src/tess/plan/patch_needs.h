#pragma once
// The segments that each patch of a set needs by itself to keep the limits, whatever its neighbours need.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "block/patch_set_impl.h"
#include "tess/bounds/cell_limits.h"
#include "tess/bounds/chord_blocks.h"
#include "tess/bounds/local_chord.h"
#include "tess/plan/plan_request.h"

namespace tessera { inline namespace abi_0_1 {

/// Returns the largest distance between a float vertex, relative to the set's origin, and the surface's point.
///
/// Each component is off by (m + n + 6) u times the largest |V|, twice that for rational patches: steps 1 to 4 of
/// kernel/sample/sample_kernel.inl.h.
double vertex_rounding(const BezierPatch& patch, const Vec3& origin);

/// The segments that a patch needs for itself, and the limits that they keep.
struct NeededSegments {
  /// Why there are none.
  enum class Failure : std::uint8_t {
    none,
    rough,         ///< the vertices alone exceed the tolerance
    rough_pixels,  ///< the vertices alone exceed the pixels
    wide,          ///< more segments than the limit
  };
  Failure failure = Failure::none;
  double cells = 0;  ///< the cells of uniform segments
  /// At most so many cells. This and the members below are set only if rates are limited to max_rate.
  PatchSegments segments;
  bool anywhere = false;  ///< see ProvenSegments
  double bound = 0, angle = 0, pixels = 0;

  bool are_found() const { return failure == Failure::none; }
};

/// Whether bounds on how normals turn are kept.
inline bool keeps_turnings(const PlannerOptions& options) { return options.angle && options.keeps_bounds; }

/// The shapes, bounds and roundings of all patches of a set.
///
/// Use: bound_block() of all blocks and bound_turning() of all patches, take_weld(), bound_views(); then the patches'
/// needs may be asked for, by any number of threads. Edits are followed block by block, see PlanUpdate.
class PatchNeeds {
 public:
  /// The set must outlive this object.
  PatchNeeds(const PatchSet::Impl& set, const PlannerOptions& options);

  /// Finds shapes, bounds and roundings of the patches of one block. Threads: any number, each with its own block.
  void bound_block(std::size_t block);
  /// Bounds how the normal of a patch turns without welding, if such bounds are kept. Threads: any number, each with
  /// its own patch; others may bound blocks.
  void bound_turning(std::size_t patch);
  /// Adds the displacements of welded vertices to the roundings, and takes note of the borders that welding makes
  /// points.
  void take_weld(const Weld& weld);
  /// Bounds how normals turn beside borders that welding makes points, if bounds are kept, and what the camera sees.
  /// Errors: cancelled.
  Status bound_views(const Execution& execution);
  /// Bounds what the camera sees of the patches of one block; needs their roundings.
  void bound_pictures(std::size_t block);

  /// Takes another camera. The blocks' pictures are then to be bounded anew.
  void look(const Camera& camera) { options_.camera = camera; }
  /// Takes an edited set in the place of the one before, of the same patches.
  void follow(const PatchSet::Impl& set);
  /// Finds the bounds of an edited block anew, at least of the lanes whose bits are set.
  void bound_chords(std::size_t block, std::uint32_t lanes) { chords_.bound(*set_, block, lanes); }
  void set_rounding(std::size_t patch, double rounding) { roundings_[patch] = rounding; }

  const PatchSet::Impl& set() const { return *set_; }
  const PlannerOptions& options() const { return options_; }
  std::span<const PatchShape> shapes() const { return shapes_; }  ///< `[patch]`, before welding
  std::span<const double> roundings() const { return roundings_; }
  double largest_rounding() const { return largest_rounding_; }  ///< of vertices before welding
  double fit_error() const { return fit_error_; }
  /// Returns the distance that a patch keeps, where `largest` is that of patches with a share of 1.
  double tolerance_of(std::size_t patch, double largest) const {
    return options_.shares.empty() ? largest : options_.shares[patch] * largest;
  }
  /// The distance from the surface that the vertices of a patch and its fit take.
  double given(std::size_t patch) const { return roundings_[patch] + fit_error_; }
  const ChordBlocks& chords() const { return chords_; }
  ChordBound chord(std::size_t patch) const { return chords_.chord(set_->slots[patch].block, set_->slots[patch].lane); }
  std::span<const ScreenSpaceBound> pictures() const { return pictures_; }  ///< `[patch]`; empty without a camera
  /// Returns the rounding of a patch's vertices before welding, once its block is bounded.
  double own_rounding(const BlockGroup& group, PatchSet::Slot slot) const;

  /// How the normal of a patch turns.
  struct NormalTurning {
    TurningBound bound;
    /// False where the surface's own normal has no bound beside a border that welding makes a point: the bound is then
    /// that of the patch with a pole there, and divides the patch, but proves nothing.
    bool is_certified = true;
  };
  /// Returns the bound of a patch, which is found anew each time unless PlannerOptions::keeps_bounds.
  NormalTurning turning_of(std::size_t patch) const;

  /// Returns the segments that keep all limits, at rates up to `most`.
  NeededSegments segments_for(std::size_t patch, const PlanRequest& request, int most) const;

 private:
  /// Replaces rates that keep the limits by segments with fewer cells, or by kept ones that keep theirs.
  ProvenSegments settle(std::size_t patch, const CellLimits& limits, const CellLimits& kept_limits, int min_rate,
                        const PlanRequest& request, Rates rates) const;

  const PatchSet::Impl* set_;
  PlannerOptions options_;
  double fit_error_;
  ChordBlocks chords_;
  std::vector<PatchShape> shapes_;
  std::vector<double> roundings_;  ///< `[patch]`: the largest error of its vertices, by rounding or by welding
  double largest_rounding_ = 0;
  std::vector<SideMask> welded_poles_;       ///< `[patch]`: borders that welding makes points; empty if it makes none
  std::vector<NormalTurning> turnings_;      ///< `[patch]`, if PlannerOptions::keeps_bounds and there is an angle
  std::vector<NormalTurning> own_turnings_;  ///< the same without welding, until bound_views()
  std::vector<ScreenSpaceBound> pictures_;   ///< `[patch]`, if there is a camera
};

/// Returns the kept segments of a patch where possible, else the best, if a distance is the only limit. `products`:
/// those that the best ones come from; null if they come from none.
ProvenSegments keep_by_distance(const PatchNeeds& needs, std::size_t patch, double distance, const KeptSegments& kept,
                                const ChordBlocks::Products* products, const ProvenSegments& best);
/// Returns the segments of a patch that cannot keep its limits: within the least multiple of them, in powers of 2, that
/// leaves room above its vertices and is kept.
NeededSegments segments_beyond(const PatchNeeds& needs, std::size_t patch, const PlanRequest& request);

/// The share of the tolerance that the rounding of vertices from float control points may take. It costs up to a third
/// more triangles, and doubles take five times as long.
inline constexpr double max_rounding = 0.25;
/// Returns PlannerOptions::f64_patches of the patches where the rounding of vertices from float control points takes
/// more than max_rounding, or all that pixels leave. `edges`: after welding.
std::vector<std::uint8_t> patches_that_need_f64(const PatchNeeds& needs, const SharedEdges& edges, double tolerance);
/// Whether the rounding of vertices leaves less than half of the tolerance.
bool is_rough(const PatchNeeds& needs, double tolerance);

}}  // namespace tessera::abi_0_1
