#pragma once
// The rays by Tessera, with which the peers are compared.

#include "peers/ray_task.h"

namespace tessera::bench {

/// The exact mode, which is the truth for the others; grid mode with hits refined onto the surface; and its facets
/// alone.
std::vector<RayRun> tessera_ray_runs(const RayTask& task);

}  // namespace tessera::bench
