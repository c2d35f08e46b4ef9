#include "exact/usable_edges.h"

#include <algorithm>

#include "tessera/topology.h"

namespace tessera { inline namespace abi_0_1 {

std::vector<UnusableEdges> drop_unusable_edges(Shape& shape) {
  std::vector<UnusableEdges> out;
  if (check_topology(shape).ok()) return out;
  Shape alone;
  alone.vertices = shape.vertices;
  alone.edges = shape.edges;
  for (std::size_t k = 0; k < shape.faces.size(); ++k) {
    ShapeFace& face = shape.faces[k];
    alone.faces.assign(1, face);
    const Status status = check_topology(alone);
    if (status.ok()) continue;
    for (Shared<std::vector<TrimLoop>>* const shared : {&face.trims, &face.outline}) {
      std::vector<TrimLoop> loops = **shared;
      for (TrimLoop& loop : loops) loop.coedges.clear();
      *shared = std::move(loops);
    }
    const std::size_t loop = std::min(status.message().find("loop "), status.message().size());
    out.push_back({k, status.message().substr(loop)});
  }
  return out;
}

}}  // namespace tessera::abi_0_1
