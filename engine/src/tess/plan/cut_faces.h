#pragma once
// The faces of a set whose loops cut patches, and the runs of loops along edges of shapes.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "block/patch_set_impl.h"
#include "tess/closing/edge_runs.h"
#include "tess/trimmed/cut_patch.h"

namespace tessera { inline namespace abi_0_1 {

/// The facts that cutting and closing take from the set's loops, whatever the tolerance is.
struct CutFaces {
  /// `closes_edges`: whether faces are to get the same vertices along edges. The set must outlive the result. Faces are
  /// shared among the threads of the caller's arena. Errors: cancelled, out_of_memory.
  static Result<CutFaces> of(const PatchSet::Impl& set, bool closes_edges, const Execution& execution);

  std::vector<FaceSides> sides;  ///< by region of the set's trims
  std::optional<EdgeRuns> runs;  ///< if edges are closed
  /// Pairs of borders along one edge, 4 * patch + side, at equal shares of which the edge has equal parameters.
  std::vector<std::array<std::uint32_t, 2>> borders_in_step;
  std::vector<std::uint8_t> names_edges;  ///< by cut patch: whether its face belongs to a shape; empty without runs
};

}}  // namespace tessera::abi_0_1
