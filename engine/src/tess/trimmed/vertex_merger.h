#pragma once
// Merges the vertices of a cut patch that rounding puts in one place.

#include <array>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "tess/edges/position_bits.h"
#include "tess/trimmed/speed_bound.h"
#include "tessera/bezier_patch.h"
#include "tessera/geometry.h"

namespace tessera { inline namespace abi_0_1 {

/// How the positions of a patch's vertices are rounded.
struct VertexRounding {
  const BezierPatch* patch = nullptr;
  Vec3 origin;             ///< of positions in float
  bool is_double = false;  ///< positions are doubles in the model's coordinates, else floats relative to the origin
  double distance = 0;     ///< the largest by which rounding moves a vertex
};

/// Finds vertices at one place. An object serves one thread at a time.
class VertexMerger {
 public:
  using Triangle = std::array<std::uint32_t, 3>;

  /// Joins the ends of each edge of `triangles` whose positions are the same numbers. Returns whether there are any.
  /// Two vertices on different sides of the patch stay apart, and so do two corners. On one side, a neighbour has the
  /// same positions and joins the same vertices.
  ///
  /// - `vertices`: in the patch's own parameters.
  bool find(const VertexRounding& rounding, const SpeedBound& speed, std::span<const ParameterPoint> vertices,
            std::span<const Triangle> triangles);
  /// The vertex that takes the place of this one: itself, or a corner, one on a side, or the first.
  std::uint32_t kept(std::uint32_t vertex) const {
    while (parents_[vertex] != vertex) vertex = parents_[vertex];
    return vertex;
  }

 private:
  void join(std::uint32_t a, std::uint32_t b, std::span<const ParameterPoint> vertices);

  std::vector<std::pair<std::uint32_t, std::uint32_t>> short_edges_;
  std::vector<std::uint32_t> parents_;
  std::unordered_map<std::uint32_t, DoublePositionBits> positions_;  ///< as rounded
};

/// The number of edges that one triangle alone has.
std::uint32_t count_lone_edges(std::span<const VertexMerger::Triangle> triangles);

}}  // namespace tessera::abi_0_1
