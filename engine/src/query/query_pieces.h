#pragma once
// The pieces of a patch set that queries by points search: parts of patches that are nearly flat, and the curves that
// bound what loops keep of them.

#include <cstdint>
#include <span>
#include <vector>

#include "kernel/table/kernel_table.h"
#include "query/kept_curve.h"
#include "query/net_parts.h"
#include "query/piece_facts.h"
#include "query/query_tree.h"
#include "ray/leaf/patch_regions.h"
#include "ray/line/ray_line.h"
#include "ray/line/set_view.h"
#include "tessera/execution.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// A part of a patch.
struct QueryPiece {
  std::uint32_t patch;
  bool is_cut;  ///< a loop may pass through it
  PatchPart area;
  PieceFacts<float> facts;
};

/// Const calls from any number of threads.
class QueryPieces {
 public:
  /// Makes pieces, curves and the tree. Errors: isa_unavailable, cancelled, out_of_memory.
  Status build(const SetView& set, const SceneFrame& frame, const Execution& execution);
  /// Makes the pieces and curves of these patches anew, cut as they were. Errors: cancelled, out_of_memory.
  Status update(const SetView& set, std::span<const std::uint32_t> patches, const Execution& execution);

  const kernel::RayKernels& kernels() const { return *kernels_; }
  const SceneFrame& frame() const { return frame_; }
  const QueryTree& tree() const { return tree_; }
  /// Items of the tree are first the pieces, then the curves.
  std::span<const QueryPiece> pieces() const { return pieces_; }
  std::span<const KeptCurve> curves() const { return curves_; }
  const PatchRegions& regions() const { return regions_; }
  /// Bounds the rounding of a point of any patch, in the scene's coordinates.
  double rounding() const { return rounding_; }
  std::size_t memory_bytes() const;

 private:
  struct PatchItems;
  void make_pieces(const SetView& set, std::uint32_t patch, PatchItems& items) const;
  std::vector<ItemBoxes> take_items(std::vector<PatchItems>&& made);
  void make_curves(const SetView& set, std::uint32_t patch, PatchItems& items) const;
  void remake_items(const SetView& set, std::uint32_t patch, QueryTree::Change* change);

  const kernel::RayKernels* kernels_ = nullptr;
  SceneFrame frame_;
  std::vector<QueryPiece> pieces_;
  std::vector<KeptCurve> curves_;
  std::vector<std::uint32_t> first_piece_, first_curve_;  ///< `[patch]`, and the ends
  PatchRegions regions_;
  QueryTree tree_;
  double rounding_ = 0;
};

}}  // namespace tessera::abi_0_1
