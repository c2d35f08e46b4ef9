#pragma once
// A bound on the distance of facets from a patch, for grid mode.

#include "tessera/bezier_patch.h"

namespace tessera { inline namespace abi_0_1 {

/// Returns an upper bound on the distance between the patch and facets with corners on it, in parameter boxes of at
/// most h x k.
double facet_deviation(const BezierPatch& patch, double h, double k);

}}  // namespace tessera::abi_0_1
