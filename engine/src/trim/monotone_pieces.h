#pragma once
// Curves cut into monotone pieces that cross no line between patches.

#include <vector>

#include "trim/cut_lines.h"
#include "trim/trim_piece.h"

namespace tessera { inline namespace abi_0_1 {

/// Appends the pieces of a curve, in its direction: cut where u or v has an extremum and where it crosses a line.
/// Pieces that are points are left out.
///
/// - `curve`: its degree-1 spans without rounding are exact lines if `error` is 0.
/// - `error`: how far it is from the caller's curve in u, and in v.
/// - `like`: gives loop, curve_index, and the range that [0, 1] stands for.
void append_monotone_pieces(PlaneBezier curve, const ParameterPoint& error, const TrimPiece& like,
                            const CutLines& lines, std::vector<TrimPiece>& pieces);

/// Moves the ends of a piece, and as much of the rest as stays not monotone then; its error grows by as much.
void move_ends(TrimPiece& piece, const ParameterPoint& start, const ParameterPoint& end);

}}  // namespace tessera::abi_0_1
