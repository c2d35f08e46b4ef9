#pragma once
// The rays by Tessera, which the peers are compared with.

#include "peers/ray_task.h"

namespace tessera::bench {

/// The exact mode, which is the truth that the others are held to; grid mode with hits refined onto the surface; and its
/// facets alone.
std::vector<RayRun> tessera_ray_runs(const RayTask& task);

}  // namespace tessera::bench
