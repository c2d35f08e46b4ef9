#pragma once
// How far the facets of a uniform grid lie from the surface.

#include "tessera/bezier_patch.h"

namespace tessera {

/// An upper bound on the distance between r(u,v) and the facets of the grid of rate_u x rate_v cells.
double facet_deviation(const BezierPatch& patch, int rate_u, int rate_v);

}  // namespace tessera
