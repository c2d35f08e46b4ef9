#pragma once
// What networks and their patches share: the check of nodes, and evaluation that needs no patch of its own.

#include "surface/checks.h"
#include "tessera/hermite_patch.h"

namespace tessera::inline abi_0_1 {

/// At least two nodes each way, as many as the grid has, all four vectors of each finite.
Status check_nodes(std::size_t count_u, std::size_t count_v, std::span<const HermiteNode> nodes);

/// The geometry matrix, by_end, of a patch with these corners.
HermitePatch::Grid geometry_of(const HermitePatch::Corners& corners);
/// The patch with this geometry over [0,1]^2.
SurfaceJet hermite_jet(const HermitePatch::Grid& geometry, double s, double t);

}  // namespace tessera::inline abi_0_1
