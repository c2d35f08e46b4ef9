#pragma once
// On which side of a monotone piece a point lies.

#include <cstdint>

#include "trim/trim_piece.h"

namespace tessera { inline namespace abi_0_1 {

/// Where a point lies seen from a piece.
enum class PieceSide : std::uint8_t {
  left,    ///< at a height of the piece, with smaller u: a ray towards larger u meets the piece once
  right,   ///< at a height of the piece, with larger u
  beside,  ///< not at a height of the piece
  near,    ///< on an exact line, or within reach of a curve, where rounding decides
};

/// The largest distances in u and in v at which a point counts as near a curve: the piece's error, and twice the
/// rounding of its evaluation at points of its box.
ParameterPoint reach(const TrimPiece& piece);

/// Returns the side of a point. Heights are half-open intervals [lower_v, upper_v), so that neighbours in a loop never
/// count twice. Exact signs for exact lines. A curve is cut until a point of it is in a quadrant that decides: one to
/// the right of q and below, where the curve rises, proves that it passes q's height on the right.
PieceSide side_of(const TrimPiece& piece, const ParameterPoint& q);

}}  // namespace tessera::abi_0_1
