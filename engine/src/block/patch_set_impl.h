#pragma once
// The inside of a PatchSet: groups of blocks, for the floors that evaluate them.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "base/aligned.h"
#include "base/internal_export.h"
#include "tessera/patch_set.h"

namespace tessera::inline abi_0_1 {

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
  std::size_t block_values = 0;       ///< values a block
  std::size_t first_point_value = 0;  ///< in the coefficients for points
  std::size_t point_values = 0;       ///< values from one patch to the next there, a multiple of 16

  /// Where a patch of this group lies in the coefficients for points.
  std::size_t point_value(const PatchSet::Slot& slot) const {
    return first_point_value + ((slot.block - first_block) * PatchSet::lanes + slot.lane) * point_values;
  }
};

/// The coefficients of all groups in one precision, over either basis; empty where not asked for.
template <class T>
struct Coefficients {
  UnsetVector<T> bernstein, power;
  /// `[block][doubt, noise][lane]`: see DegenerateNormalThreshold.
  UnsetVector<T> bernstein_doubt, power_doubt;
  /// Bernstein coefficients `[patch][i][component][j]`, patches in the order of slots, zeros in between; whole vectors
  /// may be read from the last patch too.
  UnsetVector<T> points;
  /// `[block * lanes + lane]`: doubt and noise, see DegenerateNormalThreshold; that of a curve is finite, and its noise negative.
  std::vector<std::array<T, 2>> point_doubt;
  T largest_doubt = 0;  ///< no patch's is larger
  const UnsetVector<T>& of(Representation representation) const {
    return representation == Representation::bernstein ? bernstein : power;
  }
  const UnsetVector<T>& doubt_of(Representation representation) const {
    return representation == Representation::bernstein ? bernstein_doubt : power_doubt;
  }
};

class PatchSet::Impl {
 public:
  ~Impl();

  std::vector<BezierPatch> patches;
  std::vector<PatchSource> sources;
  std::vector<Slot> slots;                  ///< of each patch
  std::vector<EdgeMask> collapsed;          ///< of each patch
  std::vector<BlockGroup> groups;           ///< by degree_u, degree_v, rational
  std::vector<std::uint32_t> lane_patches;  ///< `[block][lane]`: the patch there
  std::vector<std::uint8_t> lane_counts;    ///< of each block: lanes in use; the others repeat its first patch
  Coefficients<float> f32;
  Coefficients<double> f64;
  BlockKinds kinds;
  FitError fit_error;
  Vec3 origin;
  std::size_t surface_count = 0;
  std::uint64_t revision = 0;
  std::vector<std::uint64_t> edited;  ///< of each patch: the revision that its last edit made; 0 where there is none

  /// A new revision, in which these patches are not what they were.
  void note_edits(std::span<const std::uint32_t> of) {
    ++revision;
    for (const std::uint32_t patch : of) edited[patch] = revision;
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
  bool has(Precision precision, Representation representation) const {
    const bool bernstein = representation == Representation::bernstein;
    if (precision == Precision::single_precision) return bernstein ? kinds.float_bernstein : kinds.float_power;
    return bernstein ? kinds.double_bernstein : kinds.double_power;
  }

  bool has_points(Precision precision) const {
    return precision == Precision::single_precision ? kinds.float_points : kinds.double_points;
  }

  /// Writes a patch's collapsed edges, its lane of every kind of block, and the unused lanes that repeat it. False, and
  /// the lanes half-written, if a coefficient does not fit. Allocates nothing.
  bool pack(std::size_t index);
  /// The same but for what all patches share, so that threads may pack different patches; note_doubt() completes it.
  bool pack_lanes(std::size_t index);
  void note_doubt(std::size_t index);
  /// The lanes of all patches of a block, with the same bits; note_doubt() completes it for each of them. The first lane
  /// that doesn't fit; lanes if all do. `edits`: new points for every lane, which become the patches' own first (these
  /// have memory of their own); null: the patches' own are packed.
  std::size_t pack_block(std::size_t block, const kernel::KernelTable& kernels, const Vec3* const* edits = nullptr);

  /// PatchSet::from, without a copy, of sources that are known to be good. `box`: of all control points, where known.
  static Result<PatchSet> make(std::vector<BezierPatch> patches, std::vector<PatchSource> sources,
                               std::size_t surface_count, const std::optional<Box3>& box,
                               const PatchSetOptions& options);

 private:
  /// The Bernstein coefficients of a block of polynomial patches, their collapsed edges and boxes; as pack_block().
  std::size_t pack_polynomials(std::size_t block, const kernel::KernelTable& kernels, const Vec3* const* edits,
                               kernel::NetBoxes& boxes);
  template <class T>
  kernel::PackJob<T> pack_job(const BlockGroup& group, std::size_t block, const double* const* nets,
                              double* const* copies, Coefficients<T>& to) const;
  /// Collapsed edges and boxes alone.
  void bound_block(std::size_t block, const kernel::KernelTable& kernels, kernel::NetBoxes& boxes);
  /// A patch of `group` whose collapsed edges are known into its lane over one basis; `hull` is its box.
  bool pack_bernstein(std::size_t index, const BlockGroup& group, const Box3& hull);
  bool pack_points(std::size_t index, const BlockGroup& group, const Box3& hull);
  bool pack_power(std::size_t index, const BlockGroup& group, const Box3& hull);
  /// Errors: non_finite, of the first patch in the order of the lanes that doesn't fit.
  Status pack_all();
};

}  // namespace tessera::inline abi_0_1
