#pragma once
// The places of roots beside borders, used to recognise one from the other side.

#include <cmath>

#include "ray/border/adjacency.h"
#include "ray/line/ray_query.h"
#include "ray/line/set_view.h"

namespace tessera { inline namespace abi_0_1 {

/// Functions along an edge, an index into link_sides: of the parameter that varies there.
inline double along_edge(const LeafRoot& root, int edge) { return edge < 2 ? root.v : root.u; }
inline double reach_along(const LeafRoot& root, int edge, double apart) {
  return edge < 2 ? reach_v(root, apart) : reach_u(root, apart);
}

/// Returns whether the edge is as near to the root as another point for the same root can be.
inline bool reaches_edge(const LeafRoot& root, int edge, double apart) {
  const double across = edge < 2 ? root.u : root.v;
  return std::abs(across - edge % 2) <= (edge < 2 ? reach_u(root, apart) : reach_v(root, apart));
}

inline bool is_collapsed(const SetView& set, std::uint32_t patch, int edge) {
  return set.collapsed_sides(patch).has(link_sides[static_cast<std::size_t>(edge)]);
}
/// Returns whether the edge is a pole, and as near as that.
inline bool reaches_pole(const SetView& set, const LeafRoot& root, int edge, double apart) {
  return is_collapsed(set, root.patch, edge) && reaches_edge(root, edge, apart);
}

/// Returns the end of an edge, 0 or 1, that is a collapsed edge which the root reaches; -1 if it reaches none.
inline int pole_of_edge(const SetView& set, const LeafRoot& root, int edge, double apart) {
  const int first = edge < 2 ? 2 : 0;
  for (const int other : {first, first + 1}) {
    if (reaches_pole(set, root, other, apart)) return other % 2;
  }
  return -1;
}

inline bool reaches_vertex(const LeafRoot& root, double apart) {
  return (reaches_edge(root, 0, apart) || reaches_edge(root, 1, apart)) &&
         (reaches_edge(root, 2, apart) || reaches_edge(root, 3, apart));
}

/// Returns whether du x dv of both patches is on the same side of the surface. Their directions along the edge, with
/// the interiors to the left, are then opposite.
inline bool is_oriented_alike(int edge, const EdgeLink& link) {
  const auto has_interior_left = [](int k) { return k == 1 || k == 2; };  // in the parameter's direction
  return (has_interior_left(edge) == has_interior_left(link.edge)) == link.reversed;
}

/// Returns the place of a root at an edge as the patch beyond sees it. Gains are those of the root's own patch, with
/// the larger one for both parameters.
inline LeafRoot carried_over(const LeafRoot& root, int edge, const EdgeLink& link) {
  LeafRoot out = root;
  const double along = along_edge(root, edge), beyond = link.reversed ? 1 - along : along;
  out.patch = link.patch;
  (link.edge < 2 ? out.u : out.v) = link.edge % 2;
  (link.edge < 2 ? out.v : out.u) = beyond;
  out.gain_u = out.gain_v = std::max(root.gain_u, root.gain_v);
  out.part_u = out.part_v = std::max(root.part_u, root.part_v);
  out.upwards = root.upwards == is_oriented_alike(edge, link);
  out.has_point = false;
  return out;
}

}}  // namespace tessera::abi_0_1
