#pragma once
// Lines beside a line that passes an edge, for all its hits.

#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>
#include <vector>

#include "ray/line/ray_line.h"
#include "ray/line/ray_query.h"

namespace tessera { inline namespace abi_0_1 {

inline constexpr std::size_t ways_aside = 8;  ///< directions in which a line is moved
inline constexpr double far_aside = 2.5;      ///< how far, as a multiple of the edge's gap: out of its tube

/// Returns the line moved in one of these ways. `box`: of the scene, in its own coordinates.
inline RayLine line_aside(const RayLine& line, std::size_t way, double gap, const Box3& box) {
  const double angle = 2 * std::numbers::pi * static_cast<double>(way) / ways_aside;
  return moved(line, far_aside * gap * (std::cos(angle) * line.across[0] + std::sin(angle) * line.across[1]), box);
}

/// The roots of a line beside another.
struct RootsAside {
  RayLine line;
  std::vector<LeafRoot> roots;
  bool is_clear = false;   ///< the line passes no edge
  bool incomplete = true;  ///< there may be other roots
};

/// Returns the roots of the first line beside that of the query that passes no edge and has as many roots as it; if
/// there is none, of the one with the most; the query's own if each passes an edge. Adds to the query's steps and
/// overflow. `trace(other)` finds the roots of another query. Throws bad_alloc.
template <class Trace>
RootsAside roots_aside(RayQuery& query, const Box3& box, const Trace& trace) {
  RootsAside best{query.line, query.roots};
  for (std::size_t way = 0; way < ways_aside && !query.overflow; ++way) {
    const RayLine line = line_aside(query.line, way, query.edge_gap, box);
    RayQuery other(query.ray, line, RootsWanted::all);
    if (!line.empty) trace(other);
    query.steps += other.steps, query.overflow |= other.overflow;
    if (other.edge_gap > 0 || (best.is_clear && other.roots.size() <= best.roots.size())) continue;
    best = {line, std::move(other.roots), true, other.incomplete};
    if (best.roots.size() >= query.roots.size()) break;
  }
  return best;
}

}}  // namespace tessera::abi_0_1
