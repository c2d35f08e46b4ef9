#pragma once
// What a plan's rates keep while its patches move.

#include <cstdint>
#include <span>
#include <vector>

#include "tess/plan/certified_tessellation_impl.h"

namespace tessera::inline abi_0_1 {

/// Distances that the mesh keeps to each patch. Memory for all of them, so that no call allocates.
class PresentBounds {
 public:
  PresentBounds(const PatchSet::Impl& set, const CertifiedTessellation::Impl& plan);

  /// These patches have other control points; the bounds stay until restate().
  void touch(const PatchSet::Impl& set, std::span<const std::uint32_t> patches);
  /// Errors: cancelled; what was touched stays so.
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
  /// `products` of the patch's block.
  void set_bound(const PatchSet::Impl& set, const CertifiedTessellation::Impl& plan, std::size_t patch,
                 ChordBlocks::Products& products);

  double f64_rounding(const BezierPatch& patch, const Vec3& origin) const;

  bool is_f64_, has_f64_positions_;
  ChordBlocks chords_;
  std::vector<double> roundings_;      ///< of each patch's vertices, before welding
  std::vector<double> displacements_;  ///< of vertices that others' take the place of; empty where there are none
  std::vector<float> bounds_;
  std::vector<std::uint8_t> moved_;  ///< patches with vertices of touched ones
  std::vector<std::uint8_t> is_unproven_, is_unknown_;
  std::vector<std::uint32_t> touched_lanes_;   ///< a bit each, of each block
  std::vector<std::uint32_t> touched_blocks_;  ///< those with one
  std::size_t unproven_ = 0;
};

}  // namespace tessera::inline abi_0_1
