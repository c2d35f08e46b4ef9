#pragma once
// Roots that a kernel has proven in float, to the last digits of double.

#include "kernel/ray_kernels.h"
#include "ray/leaf_nets.h"
#include "ray/ray_query.h"

namespace tessera {

/// The one root of the leaf in the surroundings that `proven` names, by Newton's method, with the patch's point. False
/// where rounding leaves it outside of them, which leaf_search.h must then decide. `patch`: the leaf's; `with_radius`: how
/// far another may be that is the same is wanted too.
bool polish(const BezierPatch& patch, const SceneFrame& frame, const Leaf& leaf, const kernel::RayKernels& kernels,
            const RayLine& line, const kernel::RayRoot& proven, bool with_radius, LeafRoot& root);

}  // namespace tessera
