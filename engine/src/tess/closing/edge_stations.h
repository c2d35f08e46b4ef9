#pragma once
// The stations of edges: parameters at which every face along an edge has a vertex.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "base/function_ref.h"
#include "tess/cells/segments.h"
#include "tess/closing/edge_runs.h"
#include "tess/trimmed/patch_stations.h"

namespace tessera { inline namespace abi_0_1 {

/// The stations of each edge, before patches are cut: where its runs end, where sides of whole patches have vertices,
/// and where chords and sides of cut patches must be divided for any of the faces. So the faces' triangles need few
/// more vertices to meet.
class EdgeStations {
 public:
  /// Parameters within `same_share` of an edge's range count as one.
  EdgeStations(const EdgeRuns& runs, double same_share)
      : runs_(&runs), same_share_(same_share), stations_(runs.edges().edges.size()), of_runs_(runs.count()) {}

  /// The memory that a thread finds stations with.
  struct Workspace {
    PieceChords layer;
    std::vector<double> found, found_along, room;
  };
  /// Finds the stations of an edge. Threads: any number, each with its own edges and its own workspace.
  ///
  /// - `segments`: of a patch's side; none if loops cut the patch.
  /// - `limits`: of chords within a cut patch.
  void find(const PatchSet::Impl& set, std::size_t edge,
            FunctionRef<std::optional<Segments>(std::uint32_t patch, Side side)> segments,
            FunctionRef<const ChordLimits&(std::uint32_t patch)> limits, Workspace& workspace);
  /// Takes the stations of an edge that were found before, for the same limits and segments. Threads: as for find().
  void keep(EdgeStations& before, std::size_t edge);
  /// Whether the stations of an edge are the same as before.
  bool has_same(const EdgeStations& before, std::size_t edge) const {
    return stations_[edge] == before.stations_[edge];
  }
  /// The number of an edge's stations; 0 if it has a single coedge, or no chords.
  std::size_t count(std::size_t edge) const { return stations_[edge].size(); }
  /// The stations along the boundary of a cut patch, valid while this object is.
  PatchStations of(std::uint32_t patch) const;
  /// The parameters of the loop's curve where a whole patch's side has vertices within a run, along the side, without
  /// the run's ends; empty if they are not known.
  std::span<const double> at_vertices(const EdgeRun& run) const {
    return of_runs_[runs_->index(run)].chords.parameters;
  }

 private:
  RunStations& of(const EdgeRun& run) { return of_runs_[runs_->index(run)]; }
  /// Adds the ends of a run, and between them the places of a whole patch's vertices along its side. `segments`: of the
  /// side; none if loops cut the patch.
  void add_own(const EdgeRun& run, const Domain& domain, const std::optional<Segments>& segments,
               std::vector<double>& found);
  /// Adds the places where a run in a cut patch must be divided between the stations.
  void divide(const EdgeRun& run, const ChordLimits& limits, Workspace& workspace);
  /// Lays the chords of a run, which end at the stations.
  void lay(const EdgeRun& run, const ChordLimits& limits, Workspace& workspace);
  /// Whether the chords of a run end at all stations.
  bool is_laid(const EdgeRun& run, double same) const;
  /// Adds the places where the side of a run in a cut patch needs more points.
  void add_segments(const EdgeRun& run, const ChordLimits& limits, std::vector<double>& found);
  /// Lists the stations of a run as parameters of its curve.
  void list(const EdgeRun& run);
  /// Lists the places of stations along the side of a run, growing, without its ends.
  void list_along(const EdgeRun& run);

  const EdgeRuns* runs_;
  double same_share_;
  std::vector<std::vector<double>> stations_;  ///< by edge; empty if it has a single coedge, or no chords
  std::vector<RunStations> of_runs_;           ///< along whole patches: parameters of vertices in `chords` alone
};

}}  // namespace tessera::abi_0_1
