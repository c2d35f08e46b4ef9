#pragma once
// All loops of a face as one closed set of pieces within the domain.

#include <span>
#include <vector>

#include "tessera/status.h"
#include "tessera/trim_loop.h"
#include "trim/curve_extractions.h"
#include "trim/cut_lines.h"
#include "trim/trim_piece.h"

namespace tessera { inline namespace abi_0_1 {

/// Pieces in which an even number of ends meet at every point, so that the parity of crossings is a property of a
/// point alone.
struct RepairedLoops {
  std::vector<TrimPiece> pieces;
  bool starts_inside = false;  ///< whether points that no loop encloses are kept
  std::vector<LoopRemark> remarks;
};

/// Cuts, joins and repairs the loops; see TrimRegion. `shared`: extractions to take and to add to; null: none. Errors:
/// those of loop_pieces().
Result<RepairedLoops> repair_loops(std::span<const TrimLoop> loops, const CutLines& lines,
                                   CurveExtractions* shared = nullptr);

}}  // namespace tessera::abi_0_1
