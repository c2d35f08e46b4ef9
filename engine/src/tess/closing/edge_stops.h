#pragma once
// The parameters of edges at which the chords of all faces must end.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "base/function_ref.h"
#include "tess/cells/segments.h"
#include "tess/closing/edge_runs.h"
#include "tess/trimmed/patch_sides.h"
#include "tess/trimmed/piece_chords.h"

namespace tessera::inline abi_0_1 {

/// Common parameters of the faces along each edge: where its runs end, where sides of whole patches have vertices, and
/// where chords and sides of cut patches must be divided for any of the faces. So the faces' triangles need few more
/// vertices to meet.
class EdgeStops {
 public:
  /// Parameters within this share of an edge's range count as one.
  static constexpr double same_share = 1e-9;

  explicit EdgeStops(std::size_t edges) : stops_(edges) {}

  /// Finds the stops of an edge. Threads: any number, each with its own edges.
  ///
  /// - `segments`: of a patch's side; none if loops cut the patch.
  /// - `limits`: of chords within a cut patch.
  void find(const PatchSet::Impl& set, const EdgeRuns& runs, std::size_t edge,
            FunctionRef<std::optional<Segments>(std::uint32_t patch, Side side)> segments,
            FunctionRef<ChordLimits(std::uint32_t patch)> limits);
  /// Replaces the points of a cut patch's side along edges by the stops there, where no other patch has them.
  void put_on_side(const EdgeRuns& runs, std::uint32_t patch, Side side, std::vector<SidePoint>& points) const;
  /// Lists the stops of pieces of one curve into `list`, whose values the result refers to.
  ChordStops list(const EdgeRuns& runs, std::uint32_t face, std::span<const TrimPiece> pieces,
                  std::vector<double>& list) const;

 private:
  /// Adds stops to those in `stops_` where a chord, or a segment of a cut patch's side, would be too long.
  void add_chords(const EdgeRuns& runs, const EdgeRun& run, const ChordLimits& limits,
                  std::vector<double>& found) const;
  void add_segments(const EdgeRuns& runs, const EdgeRun& run, const ChordLimits& limits,
                    std::vector<double>& found) const;
  /// Returns the places of stops along the side of a run, growing, without its ends.
  std::vector<double> places_on_side(const EdgeRuns& runs, const EdgeRun& run) const;

  std::vector<std::vector<double>> stops_;  ///< by edge; empty if it has a single coedge, or no chords
};

}  // namespace tessera::inline abi_0_1
