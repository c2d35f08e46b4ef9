#pragma once
// The trims of a ray scene's leaves: which leaves the loops of their faces leave out or cut, what they keep of these,
// and whether roots there are kept.

#include <cstdint>
#include <span>
#include <vector>

#include "ray/leaf/kept_part.h"
#include "ray/leaf/leaf_nets.h"
#include "ray/leaf/patch_regions.h"
#include "ray/line/ray_query.h"
#include "tessera/execution.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// Const calls from any number of threads.
class LeafTrims final : public RootSides {
 public:
  /// Finds the uses of all leaves, and shrinks cut ones to what loops keep of them. `set`: that of the leaves; its
  /// patches may be edited, its loops not. Errors: cancelled, out_of_memory.
  Status build(const SetView& set, std::span<Leaf> leaves, const Execution& execution);
  /// Whether any patch is cut; otherwise no other call is allowed.
  bool any() const { return regions_.any(); }
  PatchUse use(std::size_t leaf) const { return squares_[leaf].use(); }
  /// The kept part of a leaf, by squares.
  const KeptSquares& squares(std::size_t leaf) const { return squares_[leaf]; }
  /// The side of all points of a cut leaf's patch within (u +- reach_u, v +- reach_v). `border`: a loop passes near,
  /// and only side_of() may tell.
  TrimSide side_near(std::uint32_t patch, double u, double v, double reach_u, double reach_v) const;
  /// The side of a root of a cut leaf. `border`: the loops pass between the places where the root may be.
  TrimSide side_of(const LeafRoot& root) const override;
  /// Always allowed.
  bool keeps(const LeafRoot& root) const override {
    return !any() || !regions_.has_region(root.patch) || side_of(root) != TrimSide::outside;
  }
  /// Whether a point of any patch, also of a whole one, is kept and on no loop. Always allowed.
  bool keeps_point(std::uint32_t patch, double u, double v) const {
    return !any() || !regions_.has_region(patch) ||
           side_near(patch, u, v, parameter_rounding, parameter_rounding) == TrimSide::inside;
  }
  std::size_t memory_bytes() const { return squares_.capacity() * sizeof(KeptSquares) + regions_.memory_bytes(); }

 private:
  KeptSquares squares_of(const SetView& set, Leaf& leaf) const;
  bool is_inside(const Leaf& leaf, double u, double v, double along_u, double along_v, int halvings) const;
  void open_sides(const Leaf& leaf, KeptSquares& squares) const;
  Domain around(std::uint32_t patch, double u, double v, double reach_u, double reach_v) const;

  const PatchSet::Impl* set_ = nullptr;
  PatchRegions regions_;
  std::vector<KeptSquares> squares_;  ///< `[leaf]`
};

}}  // namespace tessera::abi_0_1
