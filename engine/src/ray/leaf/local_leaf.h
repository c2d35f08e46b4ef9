#pragma once
// Makes the kernels' form of a piece of a patch: float, in coordinates of its own, with proven bounds.

#include "kernel/ray/ray_kernels.h"
#include "ray/net/projected_net.h"

namespace tessera { inline namespace abi_0_1 {

/// Fills `leaf` and the coefficients after it; a degenerate piece has none. `net`: of the piece, homogeneous, in the
/// scene's coordinates, 3 or 4 components.
void make_local_leaf(const NetShape<0, 0>& shape, bool rational, const double* net, kernel::RayLeaf& leaf);

}}  // namespace tessera::abi_0_1
