#pragma once
// Roots that a kernel has proven in float, to the last digits of double.

#include "kernel/ray_kernels.h"
#include "ray/leaf_nets.h"
#include "ray/ray_query.h"

namespace tessera {

/// The one root of the leaf in the surroundings that `proven` names, by Newton's method. False where rounding leaves it
/// outside of them, which leaf_search.h must then decide. `net`: the leaf's.
bool polish(const Leaf& leaf, const double* net, const RayLine& line, const kernel::RayRoot& proven, LeafRoot& root);

}  // namespace tessera
