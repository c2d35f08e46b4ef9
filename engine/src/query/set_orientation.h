#pragma once
// The open borders of a set, and how its patches are turned so that neighbours face to one side.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "query/border_arc.h"
#include "ray/border/adjacency.h"
#include "ray/line/set_view.h"
#include "tessera/execution.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// How the patches of a set are turned. Patches of one face, and patches across an edge of two faces or a border of
/// equal control points, face to one side; where that is contradictory, as on a Moebius strip, long edges count first,
/// and the others, along which patches then face to different sides, are open borders. Open borders that run beside
/// each other within 1e-2 of the set's size turn the parts to which they belong likewise.
struct SetOrientation {
  std::vector<std::int8_t> signs;    ///< `[patch]`: 1, or -1 if its normals are turned around
  std::vector<std::uint32_t> parts;  ///< `[patch]`: the first patch of its part
  std::vector<BorderArc> arcs;       ///< of open borders, with the kept part on their left
  double near = 0;                   ///< how far arcs are from the borders at most, as samples tell
};

/// Errors: cancelled.
Result<SetOrientation> orient(const SetView& set, const Adjacency& borders, const Execution& execution);

}}  // namespace tessera::abi_0_1
