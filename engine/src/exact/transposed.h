#pragma once
// Faces that run against their surface.

#include <vector>

#include "tessera/nurbs_surface.h"
#include "tessera/status.h"
#include "tessera/trim_loop.h"

namespace tessera { inline namespace abi_0_1 {

/// Swaps u and v of a surface and its loops, which turns the normal around. Errors: those of BSplineSurface and Curve.
Status turn_around(BSplineSurface& surface, std::vector<TrimLoop>& loops);

}}  // namespace tessera::abi_0_1
