#pragma once
// Holds the inner state of a PatchSet: patches and groups of blocks, for the floors that evaluate them.

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "base/aligned.h"
#include "base/internal_export.h"
#include "base/shared_slot.h"
#include "tessera/patch_set.h"

namespace tessera { inline namespace abi_0_1 {

namespace kernel {
struct KernelTable;
struct NetBoxes;
template <class T>
struct PackJob;
}  // namespace kernel

/// Blocks of equal degrees and rationality, one after the other.
struct BlockGroup {
  int degree_u = 0, degree_v = 0;
  bool rational = false;
  std::size_t first_block = 0, block_count = 0;
  std::size_t first_value = 0;        ///< in the coefficient arrays, which all have the same layout
  std::size_t block_values = 0;       ///< values per block
  std::size_t first_point_value = 0;  ///< in Coefficients::points
  std::size_t point_values = 0;       ///< values from one patch to the next in Coefficients::points, a multiple of 16

  /// Returns where a patch of this group begins in Coefficients::points.
  std::size_t point_value(const PatchSet::Slot& slot) const {
    return first_point_value + ((slot.block - first_block) * PatchSet::lanes + slot.lane) * point_values;
  }
};

/// The coefficients of all groups in one precision; kinds that the set does not hold are empty.
template <class T>
struct Coefficients {
  UnsetVector<T> bernstein, power;
  /// `[block][squared length, noise][lane]`: see DegenerateNormalThreshold.
  UnsetVector<T> bernstein_threshold, power_threshold;
  /// Bernstein coefficients `[patch][i][component][j]`, patches in the order of slots, zeros in between. Room behind
  /// the last patch lets it be read by whole vectors too.
  UnsetVector<T> points;
  /// `[block * lanes + lane]`: squared length and noise, see DegenerateNormalThreshold. The squared length of a curve
  /// is finite, and its noise negative.
  std::vector<std::array<T, 2>> point_threshold;
  T largest_threshold = 0;  ///< the largest squared length in point_threshold, or more
  const UnsetVector<T>& of(Representation representation) const {
    return representation == Representation::bernstein ? bernstein : power;
  }
  const UnsetVector<T>& threshold_of(Representation representation) const {
    return representation == Representation::bernstein ? bernstein_threshold : power_threshold;
  }
};

/// Coefficients for scattered points of a set that was made without them, as of a revision.
template <class T>
struct PointsOnDemand {
  std::uint64_t revision = 0;
  Coefficients<T> coefficients;
};

struct PatchEdges;
struct PatchTrims;

class PatchSet::Impl {
 public:
  ~Impl();

  std::vector<BezierPatch> patches;
  std::vector<PatchSource> sources;
  std::vector<Slot> slots;                  ///< `[patch]`
  std::vector<SideMask> collapsed;          ///< `[patch]`
  std::vector<BlockGroup> groups;           ///< in the order of degree_u, degree_v, rational
  std::vector<std::uint32_t> lane_patches;  ///< `[block][lane]`: the patch there
  std::vector<std::uint8_t> lane_counts;    ///< `[block]`: lanes in use; the others repeat the block's first patch
  Coefficients<float> f32;
  Coefficients<double> f64;
  BlockKinds kinds;
  FitError fit_error;
  Vec3 origin;
  std::optional<Box3> given_box;  ///< PatchSetOptions::box
  std::size_t surface_count = 0;
  std::vector<Domain> domains;              ///< `[surface]`; empty if the set was made of patches
  std::shared_ptr<const PatchTrims> trims;  ///< null if no patch is cut
  std::shared_ptr<const PatchEdges> edges;  ///< null if no face names edges
  std::vector<Status> trim_faults;          ///< one for each surface whose loops could not be used
  /// Tells this set from all others, also from those that have its memory after it is gone: plans keep it.
  const std::shared_ptr<const void> identity = std::make_shared<char>();
  std::uint64_t revision = 0;
  std::vector<std::uint64_t> edited;  ///< `[patch]`: the revision that its last edit made; 0 without an edit
  /// Tables that plans of this set share, of a type that they alone know, without and with tables of bicubic points.
  mutable std::array<SharedSlot<void>, 2> plan_tables;
  mutable SharedSlot<PointsOnDemand<float>> f32_points;
  mutable SharedSlot<PointsOnDemand<double>> f64_points;

  /// Begins a new revision, in which these patches have been edited.
  void note_edits(std::span<const std::uint32_t> of) {
    ++revision;
    for (const std::uint32_t patch : of) edited[patch] = revision;
    f32_points.store(nullptr);
    f64_points.store(nullptr);
  }

  const BlockGroup& group_of_block(std::size_t block) const;
  template <class T>
  const Coefficients<T>& coefficients() const {
    if constexpr (sizeof(T) == 4) {
      return f32;
    } else {
      return f64;
    }
  }
  TESSERA_INTERNAL_EXPORT Box3 box() const;
  TESSERA_INTERNAL_EXPORT Box3 model_box() const { return given_box ? *given_box : box(); }
  bool has(Precision precision, Representation representation) const {
    const bool bernstein = representation == Representation::bernstein;
    if (precision == Precision::single_precision) return bernstein ? kinds.float_bernstein : kinds.float_power;
    return bernstein ? kinds.double_bernstein : kinds.double_power;
  }

  /// Returns the coefficients for scattered points. A set that was made without them packs them now, and keeps them
  /// until it is edited. Errors: non_finite (index = the patch), cancelled.
  template <class T>
  Result<std::shared_ptr<const Coefficients<T>>> points(const std::atomic<bool>* cancel) const;

  /// Writes a patch's collapsed sides, its lane of every kind of block, and the unused lanes that repeat it. Returns
  /// false, with the lanes half-written, if a coefficient does not fit. Allocates nothing.
  bool pack(std::size_t index);
  /// Does what pack() does, except for the value that all patches share, so that threads may pack different patches;
  /// note_threshold() completes it.
  bool pack_lanes(std::size_t index);
  void note_threshold(std::size_t index);
  /// Writes the lanes of all patches of a block, with the same bits as pack_lanes(); note_threshold() completes each of
  /// them. Returns the first lane that doesn't fit, or `lanes` if all do. `edits`: new points for every lane, which
  /// first become the patches' own (each patch must have memory of its own); null: packs the patches' present points.
  std::size_t pack_block(std::size_t block, const kernel::KernelTable& kernels, const Vec3* const* edits = nullptr);

  /// PatchSet::make() without a copy; the sources must be valid. `box`: of all control points, if known.
  static Result<PatchSet> make(std::vector<BezierPatch> patches, std::vector<PatchSource> sources,
                               std::size_t surface_count, const std::optional<Box3>& box,
                               const PatchSetOptions& options);

 private:
  /// Writes the Bernstein coefficients of a block of polynomial patches, their collapsed sides and boxes; result and
  /// `edits` as in pack_block().
  std::size_t pack_polynomials(std::size_t block, const kernel::KernelTable& kernels, const Vec3* const* edits,
                               kernel::NetBoxes& boxes);
  template <class T>
  kernel::PackJob<T> pack_job(const BlockGroup& group, std::size_t block, const double* const* nets,
                              double* const* copies, Coefficients<T>& to) const;
  /// Finds only the collapsed sides and boxes of a block's patches.
  void bound_block(std::size_t block, const kernel::KernelTable& kernels, kernel::NetBoxes& boxes);
  /// Pack one kind of coefficients of a patch of `group` whose collapsed sides are known; `hull` is its box. Return
  /// false if a coefficient does not fit.
  bool pack_bernstein(std::size_t index, const BlockGroup& group, const Box3& hull);
  /// Writes to memory that has room for coefficients for scattered points, or to none if it is null.
  bool pack_points(std::size_t index, const BlockGroup& group, const Box3& hull, Coefficients<float>* to_f32,
                   Coefficients<double>* to_f64) const;
  bool pack_points(std::size_t index, const BlockGroup& group, const Box3& hull) {
    return pack_points(index, group, hull, kinds.float_points ? &f32 : nullptr, kinds.double_points ? &f64 : nullptr);
  }
  bool pack_power(std::size_t index, const BlockGroup& group, const Box3& hull);
  /// Packs all patches. Errors: non_finite (the first patch in the order of the lanes that doesn't fit), cancelled.
  Status pack_all(const Execution& execution);
};

}}  // namespace tessera::abi_0_1
