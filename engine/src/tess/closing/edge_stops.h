#pragma once
// The parameters of edges at which the chords of all faces must end.

#include <cstdint>
#include <span>
#include <vector>

#include "base/function_ref.h"
#include "tess/cells/segments.h"
#include "tess/closing/edge_runs.h"
#include "tess/trimmed/piece_chords.h"

namespace tessera::inline abi_0_1 {

/// Common parameters of the faces along each edge: where its runs end, where sides of patches have vertices, and where
/// chords must be divided for any of the faces. So the faces' triangles need few more vertices to meet.
class EdgeStops {
 public:
  /// Parameters within this share of an edge's range count as one.
  static constexpr double same_share = 1e-9;

  explicit EdgeStops(std::size_t edges) : stops_(edges) {}

  /// Finds the stops of an edge. Threads: any number, each with its own edges.
  ///
  /// - `segments`: of a patch's side.
  /// - `limits`: of chords within a patch.
  void find(const PatchSet::Impl& set, const EdgeRuns& runs, std::size_t edge,
            FunctionRef<Segments(std::uint32_t patch, Side side)> segments,
            FunctionRef<ChordLimits(std::uint32_t patch)> limits);
  /// Lists the stops of pieces of one curve into `list`, whose values the result refers to.
  ChordStops list(const EdgeRuns& runs, std::uint32_t face, std::span<const TrimPiece> pieces,
                  std::vector<double>& list) const;

 private:
  std::vector<std::vector<double>> stops_;  ///< by edge; empty if it has a single coedge, or no chords
};

}  // namespace tessera::inline abi_0_1
