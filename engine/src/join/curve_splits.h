#pragma once
// Where the ends of other curves divide a curve.

#include "join/free_curves.h"

namespace tessera { inline namespace abi_0_1 {

/// Divides each curve at its sharp corners, and where an end or a corner of another comes within its reach. Places
/// nearer to each other than the reach are one. Each new node gets a vertex. The nodes of a curve do not depend on the
/// order of curves. Time: O(n log n) for n curves that have few neighbours.
void split_curves(FreeCurves& free, std::vector<BrepVertex>& vertices);

}}  // namespace tessera::abi_0_1
