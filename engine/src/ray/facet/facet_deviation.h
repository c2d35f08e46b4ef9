#pragma once
// How far facets lie from the surface.

#include "tessera/bezier_patch.h"

namespace tessera::inline abi_0_1 {

/// An upper bound on the distance between the patch and facets with corners on it, in boxes of its parameters of h x k at the
/// most.
double facet_deviation(const BezierPatch& patch, double h, double k);

}  // namespace tessera::inline abi_0_1
