#include "render/face_borders.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <vector>

namespace tessera::render {
namespace {

/// Returns for each vertex the first one at its position, in some order of all positions.
std::vector<std::uint32_t> first_at_position(const Mesh& mesh) {
  const auto at = [&](std::uint32_t v) {
    const float* const p = &mesh.positions[3 * std::size_t{v}];
    return std::array{p[0], p[1], p[2]};
  };
  std::vector<std::uint32_t> order(mesh.vertex_count()), first(order.size());
  std::iota(order.begin(), order.end(), 0u);
  std::ranges::sort(order, {}, at);
  for (std::size_t k = 0; k < order.size(); ++k)
    first[order[k]] = k > 0 && at(order[k]) == at(order[k - 1]) ? first[order[k - 1]] : order[k];
  return first;
}

/// An edge of one face, by its vertices in ascending order.
using FaceEdge = std::array<std::uint32_t, 3>;

std::vector<FaceEdge> edges_by_face(const Mesh& mesh, std::span<const std::uint32_t> faces) {
  const std::vector<std::uint32_t> first = first_at_position(mesh);
  std::vector<FaceEdge> edges;
  edges.reserve(mesh.indices.size());
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t a = first[mesh.indices[3 * t + c]], b = first[mesh.indices[3 * t + (c + 1) % 3]];
      if (a != b) edges.push_back({faces[t], std::min(a, b), std::max(a, b)});
    }
  }
  std::ranges::sort(edges);
  return edges;
}

}  // namespace

Mesh face_borders(const Mesh& mesh, std::span<const std::uint32_t> faces) {
  Mesh borders;
  borders.origin = mesh.origin;
  borders.positions = mesh.positions;
  const std::vector<FaceEdge> edges = edges_by_face(mesh, faces);
  for (auto at = edges.begin(); at != edges.end();) {
    const auto next = std::find_if(at, edges.end(), [&](const FaceEdge& edge) { return edge != *at; });
    // A triangle without area, two of whose corners are in one place, lists its only edge twice: hence odd, not one.
    if ((next - at) % 2 == 1) borders.indices.insert(borders.indices.end(), {(*at)[1], (*at)[2], (*at)[2]});
    at = next;
  }
  return borders;
}

}  // namespace tessera::render
