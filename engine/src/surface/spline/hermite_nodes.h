#pragma once
// Functions shared by Hermite networks and their patches: a check of nodes, and evaluation without making a patch.

#include "surface/net/checks.h"
#include "tessera/hermite_patch.h"

namespace tessera { inline namespace abi_0_1 {

/// Checks that there are at least two nodes each way, as many as the grid has, with four finite vectors each.
Status check_nodes(std::size_t count_u, std::size_t count_v, std::span<const HermiteNode> nodes);

/// Returns the geometry matrix, by_end, of a patch with these corners.
HermitePatch::Grid geometry_of(const HermitePatch::Corners& corners);
/// Evaluates the patch with this geometry over [0,1]^2.
SurfaceJet hermite_jet(const HermitePatch::Grid& geometry, double s, double t);

}}  // namespace tessera::abi_0_1
