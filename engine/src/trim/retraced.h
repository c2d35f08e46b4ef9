#pragma once
// Parts of a loop that run back over themselves.

#include <cstddef>
#include <vector>

#include "trim/trim_piece.h"

namespace tessera { inline namespace abi_0_1 {

/// Drops pairs of pieces that are the same curve within `snap_u` and `snap_v`, in the same direction or in opposite
/// ones: no point lies between them. Lines as short as that join what is left. Returns how many pieces were dropped.
std::size_t drop_retraced(std::vector<TrimPiece>& pieces, double snap_u, double snap_v);

}}  // namespace tessera::abi_0_1
