#pragma once
// The parameters of edges at which the chords of all faces must end.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "base/function_ref.h"
#include "tess/cells/segments.h"
#include "tess/closing/edge_runs.h"
#include "tess/trimmed/trimmed_patch.h"

namespace tessera { inline namespace abi_0_1 {

/// Common parameters of the faces along each edge: where its runs end, where sides of whole patches have vertices, and
/// where chords and sides of cut patches must be divided for any of the faces. So the faces' triangles need few more
/// vertices to meet.
class EdgeStops {
 public:
  /// Parameters within `same_share` of an edge's range count as one.
  EdgeStops(const EdgeRuns& runs, double same_share)
      : runs_(&runs), same_share_(same_share), stops_(runs.edges().edges.size()), chords_(runs.count()) {}

  /// The memory that a thread finds stops with.
  struct Workspace {
    PieceChords layer;
    std::vector<double> found, listed;
  };
  /// Finds the stops of an edge. Threads: any number, each with its own edges and its own workspace.
  ///
  /// - `segments`: of a patch's side; none if loops cut the patch.
  /// - `limits`: of chords within a cut patch.
  void find(const PatchSet::Impl& set, std::size_t edge,
            FunctionRef<std::optional<Segments>(std::uint32_t patch, Side side)> segments,
            FunctionRef<const ChordLimits&(std::uint32_t patch)> limits, Workspace& workspace);
  /// Takes the stops of an edge that were found before, for the same limits and segments. Threads: as for find().
  void keep(EdgeStops& before, std::size_t edge);
  /// Whether the stops of an edge are the same as before.
  bool has_same(const EdgeStops& before, std::size_t edge) const { return stops_[edge] == before.stops_[edge]; }
  /// Replaces the points of a cut patch's side along edges by the stops there, where no other patch has them.
  void put_on_side(std::uint32_t patch, Side side, std::vector<SidePoint>& points) const;
  /// The chords of a run of `count` pieces, which end at all stops; null if there is none.
  const LaidChords* laid(std::uint32_t face, std::uint32_t first, std::size_t count) const;
  /// The parameters of the loop's curve where a whole patch's side has vertices within a run, along the side, without
  /// the run's ends; empty if they are not known.
  std::span<const double> at_vertices(const EdgeRun& run) const { return chords_[runs_->index(run)].parameters; }
  /// Lists the stops of pieces of one curve into `list`, whose values the result refers to.
  ChordStops list(std::uint32_t face, std::span<const TrimPiece> pieces, std::vector<double>& list) const;

 private:
  /// Adds the places of a whole patch's vertices along the side of a run, without its ends.
  void add_vertices(const EdgeRun& run, const Domain& domain, const Segments& segments, std::vector<double>& found);
  /// Adds the places where a run in a cut patch must be divided between the stops.
  void divide(const EdgeRun& run, const ChordLimits& limits, Workspace& workspace);
  /// Lays the chords of a run, which end at the stops.
  void lay(const EdgeRun& run, const ChordLimits& limits, Workspace& workspace);
  /// Whether the chords of a run end at all stops.
  bool is_laid(const EdgeRun& run, double same) const;
  /// Adds the places where the side of a run in a cut patch needs more points.
  void add_segments(const EdgeRun& run, const ChordLimits& limits, std::vector<double>& found) const;
  /// Returns the places of stops along the side of a run, growing, without its ends.
  std::vector<double> places_on_side(const EdgeRun& run) const;

  const EdgeRuns* runs_;
  double same_share_;
  std::vector<std::vector<double>> stops_;  ///< by edge; empty if it has a single coedge, or no chords
  std::vector<LaidChords> chords_;          ///< by run; along sides: parameters of a whole patch's vertices alone
};

/// The demands of edges on one cut patch of a face.
class PatchStops final : public EdgeDemands {
 public:
  PatchStops(const EdgeStops& stops, std::uint32_t patch, std::uint32_t face)
      : stops_(stops), patch_(patch), face_(face) {}
  const LaidChords* laid(std::uint32_t first, std::size_t count) const override {
    return stops_.laid(face_, first, count);
  }
  ChordStops stops(std::span<const TrimPiece> chain) const override { return stops_.list(face_, chain, list_); }
  void put_on_side(Side side, std::vector<SidePoint>& points) const override {
    stops_.put_on_side(patch_, side, points);
  }

 private:
  const EdgeStops& stops_;
  std::uint32_t patch_, face_;
  mutable std::vector<double> list_;
};

}}  // namespace tessera::abi_0_1
