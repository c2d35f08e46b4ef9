#pragma once
// Tells which patches are thin strips or needles.

#include <cstddef>

#include "block/patch_set_impl.h"
#include "tess/cells/patch_side.h"

namespace tessera { inline namespace abi_0_1 {

/// Whether no control point of a patch lies farther than `reach` from the one of a side that it is across from.
bool is_thin(const BezierPatch& patch, Side side, double reach);
/// Whether all control points of a patch lie within `reach` of the straight line from one end of a side to the other.
bool is_needle(const BezierPatch& patch, Side side, double reach);

}}  // namespace tessera::abi_0_1
