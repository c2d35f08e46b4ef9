#include "ray/tree/facet_tree.h"

#include <string>

namespace tessera { inline namespace abi_0_1 {

Status FacetTree::check_size(const GridVertices& vertices) {
  const std::size_t per_grid = static_cast<std::size_t>(vertices.height) * static_cast<std::size_t>(vertices.width);
  if (vertices.height > max_vertices_per_side || vertices.width > max_vertices_per_side ||
      vertices.grids > std::numeric_limits<std::uint32_t>::max() / per_grid)
    return Status(StatusCode::unsupported, std::to_string(vertices.grids) + " grids of " + std::to_string(per_grid) +
                                               " vertices are more than the 2^32 vertices of one ray scene");
  return {};
}

}}  // namespace tessera::abi_0_1
