#pragma once
// The slits between faces along their common edges, as samples find them.

#include <vector>

#include "tessera/execution.h"
#include "tessera/geometry.h"
#include "tessera/model.h"
#include "tessera/status.h"
#include "tessera/topology.h"

namespace tessera { inline namespace abi_0_1 {

/// The slit along an edge: no wider than `width` at the samples.
struct EdgeSlit {
  double width = 0, length = 0;
  Box3 box;  ///< of the samples
};
/// Samples all edges of a shape. Errors: those of evaluate_jet(), cancelled.
Result<std::vector<EdgeSlit>> edge_slits(const Shape& shape, const EdgeUses& uses, const Execution& execution);

}}  // namespace tessera::abi_0_1
