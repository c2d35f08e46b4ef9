#pragma once
// The check that all that takes a network's nodes shares.

#include "surface/checks.h"
#include "tessera/hermite_network.h"

namespace tessera {

/// At least two nodes each way, as many as the grid has, all four vectors of each finite.
Status check_nodes(std::size_t count_u, std::size_t count_v, std::span<const HermiteNode> nodes);

}  // namespace tessera
