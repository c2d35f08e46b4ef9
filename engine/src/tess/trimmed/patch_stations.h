#pragma once
// The stations of edges along the boundary of one patch, as plain data for the cutter.
//
// A station is a parameter of a shape's edge at which every face along the edge has a vertex. Stations are found edge
// by edge before patches are cut: tess/closing/edge_stations.h.

#include <cstdint>
#include <span>
#include <vector>

#include "tess/cells/patch_side.h"
#include "tess/trimmed/patch_sides.h"
#include "tess/trimmed/piece_chords.h"

namespace tessera { inline namespace abi_0_1 {

/// The stations along a run: pieces of a loop that follow each other along one edge, within one patch or along its
/// side.
struct RunStations {
  std::uint32_t first = 0, end = 0;  ///< the pieces, of the face's region
  /// Within a patch: parameters of the caller's curve, growing, with the nearest stations before and after the run.
  std::vector<double> at;
  double same = 0;    ///< nearer to an end of a piece, a station is that end
  LaidChords chords;  ///< within a patch: they end at all stations; empty if they are not known

  // Along a side of a cut patch:
  Side side{};
  double low = 0, high = 0;   ///< the run's ends along the side
  std::vector<double> along;  ///< the stations' places between them, growing
};

/// The runs of one patch. Those within it are listed by growing first piece.
struct PatchStations {
  std::vector<const RunStations*> within, on_sides;

  /// Returns the run within the patch that has a piece; null if there is none.
  const RunStations* run_of(std::uint32_t piece) const;
  /// Replaces the points of a side along edges by the stations there, where no other patch has them.
  void put_on_side(Side side, std::vector<SidePoint>& points) const;
};

}}  // namespace tessera::abi_0_1
