#pragma once
// The pieces of one loop: its curves cut into monotone pieces, moved into the domain of a periodic surface, and joined.

#include <cstdint>
#include <vector>

#include "tessera/status.h"
#include "tessera/trim_loop.h"
#include "trim/curve_extractions.h"
#include "trim/cut_lines.h"
#include "trim/trim_piece.h"

namespace tessera { inline namespace abi_0_1 {

/// A loop as a closed chain of pieces. On a periodic surface, a piece that ends on one side of the domain may be
/// followed by one that starts at the same place of the opposite side.
struct LoopPieces {
  std::vector<TrimPiece> pieces;
  std::size_t gaps = 0;  ///< how many gaps wider than rounding were closed by a line
  double largest_gap = 0;
  std::size_t gap_curve = 0;     ///< the curve before the largest gap
  int turns_u = 0, turns_v = 0;  ///< how often it runs around the surface along u and along v
  /// On a surface that is periodic along u and v, for a loop that runs around neither: whether it encloses a point just
  /// above the domain's lower left corner and just right of the seam (holds_left), or just above the lower right corner
  /// and just left of the seam. A point counts as enclosed if an odd number of its copies, a period apart, are.
  bool holds_left = false, holds_right = false;
};

/// Makes the pieces of a loop. `extractions`: those to take and to add to. Errors: unsupported (coordinates beyond
/// 1e100; more than 64 periods).
Result<LoopPieces> loop_pieces(const TrimLoop& loop, std::uint32_t index, const CutLines& lines,
                               CurveExtractions& extractions);

}}  // namespace tessera::abi_0_1
