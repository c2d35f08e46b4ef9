#pragma once
// The grid by Tessera, with which the peers are compared.

#include "peers/grid_task.h"
#include "tessera/nurbs_surface.h"

namespace tessera::bench {

BSplineSurface surface_of(const GridTask& task);

/// Float in blocks, float interleaved, double in blocks, double interleaved.
std::vector<GridRun> tessera_runs(const GridTask& task);

}  // namespace tessera::bench
