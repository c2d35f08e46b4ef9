#pragma once
// The edges of a set's faces: which patches each face has, and where its loops run along edges of its shape.

#include <cstdint>
#include <vector>

#include "tessera/brep.h"
#include "tessera/curve.h"
#include "tessera/detail/shared.h"
#include "tessera/geometry.h"
#include "tessera/trim_loop.h"
#include "tessera/trim_region.h"

namespace tessera { inline namespace abi_0_1 {

/// The edges of all shapes, or instances of shapes, that a set is made of, one after the other.
struct PatchEdges {
  struct Edge {
    Interval range;
    std::uint32_t start, end;  ///< vertices, or no_id
    bool degenerate;
  };
  /// A face whose loops name edges.
  struct Face {
    std::uint32_t first_edge;             ///< what its coedges count from, in `edges`
    Shared<std::vector<TrimLoop>> loops;  ///< in the parameters of its patches: trims, or the outline
    TrimRegion region;                    ///< of the loops, made for patches
    std::vector<std::uint32_t> patches;   ///< by place in the region's grid: the patch, or no_id where it is left out
  };
  std::vector<Edge> edges;
  std::vector<Vec3> vertices;  ///< where the shapes state them, in the model
  std::vector<Face> faces;
};

}}  // namespace tessera::abi_0_1
