#pragma once
// The directions of a shell's faces: how normals must be turned so that all point to the same side.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "measure/edge_slits.h"
#include "tessera/model.h"
#include "tessera/status.h"
#include "tessera/topology.h"

namespace tessera { inline namespace abi_0_1 {

/// The loops of a face: 1 where the kept part is on the left in the parameters, -1 where it is on the right.
using LoopDirections = std::vector<std::int8_t>;

/// Returns the directions of the loops that name a face's edges.
LoopDirections directions_of(const ShapeFace& face);

/// A face of a shell, and 1 or -1: the side of its normal that is outside, or inside, for all faces alike of a part.
struct OrientedFace {
  std::uint32_t face;
  int sign;
  std::uint32_t part;  ///< faces of a shell that edges join have the same
};
struct OrientedShell {
  std::vector<OrientedFace> faces;
  std::uint32_t parts = 0;
  /// Two faces each, of an edge that does not agree: one of them may be turned the wrong way.
  std::vector<std::array<std::uint32_t, 2>> conflicts = {};
};
/// Orients the faces of a shell: along an edge of two faces, both run in opposite directions. Long edges count first;
/// edges that do not agree may be a hundredth of all in length. `directions`, `slits`: of all faces and edges of the
/// shape. Errors: invalid_argument (faces that cannot be oriented).
Result<OrientedShell> oriented_shell(const Shape& shape, const std::vector<std::uint32_t>& shell,
                                     const std::vector<LoopDirections>& directions, const std::vector<EdgeSlit>& slits);

/// Says which edges of some faces are open: "2 open edges: 17, 23"; empty if none is.
std::string open_edges_of(const Shape& shape, const std::vector<std::uint32_t>& faces);

}}  // namespace tessera::abi_0_1
