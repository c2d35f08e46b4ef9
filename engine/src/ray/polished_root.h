#pragma once
// Roots that a kernel has proven in float, to the last digits of double.

#include "kernel/ray_kernels.h"
#include "ray/leaf_nets.h"
#include "ray/ray_query.h"

namespace tessera {

/// Where Newton's method begins in the patch, and how far from there the root can be, twice over.
struct RootStart {
  double u, v, reach_u, reach_v;
};
inline RootStart start_of(const Leaf& leaf, const kernel::RayRoot& root) {
  const double u = root.u, v = root.v, radius_u = root.radius_u, radius_v = root.radius_v;
  return {leaf.u0 + (0.5 + u) * leaf.du, leaf.v0 + (0.5 + v) * leaf.dv, 2 * radius_u * leaf.du, 2 * radius_v * leaf.dv};
}

/// The one root of the leaf in the surroundings that `proven` names, by Newton's method, with the patch's point. False
/// where rounding leaves it outside of them, which leaf_search.h must then decide. `patch`: the leaf's; `with_radius`: how
/// far another may be that is the same is wanted too.
bool polish(const BezierPatch& patch, const SceneFrame& frame, const Leaf& leaf, const kernel::RayKernels& kernels,
            const RayLine& line, const kernel::RayRoot& proven, bool with_radius, LeafRoot& root);

}  // namespace tessera
