#pragma once
// Bounds the distances that a plan's rates keep while its patches move.

#include <cstdint>
#include <span>
#include <vector>

#include "tess/mesh/certified_tessellation_impl.h"

namespace tessera::inline abi_0_1 {

/// The distances that the mesh keeps to each patch. Holds memory for all patches, so that no call allocates.
class PresentBounds {
 public:
  PresentBounds(const PatchSet::Impl& set, const CertifiedTessellation::Impl& plan);

  /// Notes that these patches have new control points; their bounds are unchanged until restate().
  void touch(const PatchSet::Impl& set, std::span<const std::uint32_t> patches);
  /// Finds the bounds of touched patches anew. Errors: cancelled; touched patches then stay touched.
  Status restate(const PatchSet::Impl& set, const CertifiedTessellation::Impl& plan, const Execution& execution);

  std::span<const float> bounds() const { return bounds_; }
  double bound() const;
  std::size_t unproven() const { return unproven_; }

 private:
  bool is_touched(const PatchSet::Impl& set, std::size_t patch) const {
    return touched_lanes_[set.slots[patch].block] >> set.slots[patch].lane & 1u;
  }
  Status bound_blocks(const PatchSet::Impl& set, const Execution& execution);
  void find_moved(const PatchSet::Impl& set, const CertifiedTessellation::Impl& plan);
  /// Sets a patch's bound; `products` are those of its block.
  void set_bound(const PatchSet::Impl& set, const CertifiedTessellation::Impl& plan, std::size_t patch,
                 ChordBlocks::Products& products);

  double f64_rounding(const BezierPatch& patch, const Vec3& origin) const;

  bool is_f64_, has_f64_positions_;
  ChordBlocks chords_;
  std::vector<double> roundings_;      ///< `[patch]`: roundings of its vertices, before welding
  std::vector<double> displacements_;  ///< `[patch]`: how far copies move its vertices; empty where there are no copies
  std::vector<float> bounds_;          ///< `[patch]`
  std::vector<std::uint8_t> moved_;    ///< `[patch]`: 1 if it copies vertices, and it or their source is touched
  /// `[patch]`: 1 if its bound exceeds the tolerance or it is unknown; 1 if its angle or pixels are no longer known.
  std::vector<std::uint8_t> is_unproven_, is_unknown_;
  std::vector<std::uint32_t> touched_lanes_;   ///< `[block]`: one bit per touched lane
  std::vector<std::uint32_t> touched_blocks_;  ///< blocks with a touched lane
  std::size_t unproven_ = 0;
};

}  // namespace tessera::inline abi_0_1
