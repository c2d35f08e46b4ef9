#pragma once
// Rows of control points counted from an edge of a patch, for making and measuring joins.

#include <cmath>
#include <string>

#include "base/text.h"
#include "tessera/bezier_operations.h"
#include "tessera/bezier_patch.h"
#include "tessera/geometry.h"

namespace tessera { inline namespace abi_0_1 {

inline bool crosses_u(Edge edge) { return edge == Edge::u0 || edge == Edge::u1; }
inline bool is_edge(Edge edge) { return crosses_u(edge) || edge == Edge::v0 || edge == Edge::v1; }

/// Degrees and indices seen from an edge: row 0 is the border, and k runs along it, with the parameter or (reversed)
/// against it.
struct EdgeView {
  EdgeView(int m, int n, Edge seen_from, bool against)
      : edge(seen_from),
        reversed(against),
        across(crosses_u(seen_from) ? m : n),
        along(crosses_u(seen_from) ? n : m),
        degree_v(n) {}

  std::size_t index(int row, int k) const {
    const int place = reversed ? along - k : k;
    const int depth = edge == Edge::u1 || edge == Edge::v1 ? across - row : row;
    return static_cast<std::size_t>(crosses_u(edge) ? depth * (degree_v + 1) + place : place * (degree_v + 1) + depth);
  }

  Edge edge;
  bool reversed;
  int across, along, degree_v;
};
inline EdgeView edge_view(const BezierPatch& patch, Edge edge, bool reversed) {
  return {patch.degree_u(), patch.degree_v(), edge, reversed};
}

/// Returns the domain's length in the direction that crosses the edge.
inline double width_across(const JoinSide& side) {
  return crosses_u(side.edge) ? side.domain.u1 - side.domain.u0 : side.domain.v1 - side.domain.v0;
}

inline Status check_side(const JoinSide& side, const char* which) {
  if (!is_edge(side.edge))
    return {StatusCode::invalid_argument, std::string("the edge of patch ") + which + " must be u0, u1, v0 or v1"};
  const double width = side.domain.u1 - side.domain.u0, height = side.domain.v1 - side.domain.v0;
  if (!std::isfinite(width) || !std::isfinite(height))
    return {StatusCode::non_finite, std::string("the domain of patch ") + which + " is not finite"};
  if (width > 0 && height > 0) return {};
  return {StatusCode::invalid_argument,
          std::string("the domain of patch ") + which + " is empty or reversed: " + text(width) + " x " + text(height)};
}

}}  // namespace tessera::abi_0_1
