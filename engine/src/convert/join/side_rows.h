#pragma once
// Rows of control points counted from a side of a patch, for making and measuring joins.

#include <cmath>
#include <string>

#include "base/text.h"
#include "tessera/bezier_operations.h"
#include "tessera/bezier_patch.h"
#include "tessera/geometry.h"

namespace tessera { inline namespace abi_0_1 {

inline bool crosses_u(Side side) { return side == Side::u0 || side == Side::u1; }

/// Degrees and indices seen from a side: row 0 is the border, and k runs along it, with the parameter or (reversed)
/// against it.
struct SideView {
  SideView(int m, int n, Side seen_from, bool against)
      : side(seen_from),
        reversed(against),
        across(crosses_u(seen_from) ? m : n),
        along(crosses_u(seen_from) ? n : m),
        degree_v(n) {}

  std::size_t index(int row, int k) const {
    const int place = reversed ? along - k : k;
    const int depth = side == Side::u1 || side == Side::v1 ? across - row : row;
    return static_cast<std::size_t>(crosses_u(side) ? depth * (degree_v + 1) + place : place * (degree_v + 1) + depth);
  }

  Side side;
  bool reversed;
  int across, along, degree_v;
};
inline SideView side_view(const BezierPatch& patch, Side side, bool reversed) {
  return {patch.degree_u(), patch.degree_v(), side, reversed};
}

/// Returns the domain's length in the direction that crosses the side.
inline double width_across(const JoinedPatch& joined) {
  return crosses_u(joined.side) ? joined.domain.u1 - joined.domain.u0 : joined.domain.v1 - joined.domain.v0;
}

inline Status check_joined(const JoinedPatch& joined, const char* which) {
  if (joined.side > Side::u0)
    return {StatusCode::invalid_argument, std::string("the side of patch ") + which + " must be u0, u1, v0 or v1"};
  const double width = joined.domain.u1 - joined.domain.u0, height = joined.domain.v1 - joined.domain.v0;
  if (!std::isfinite(width) || !std::isfinite(height))
    return {StatusCode::non_finite, std::string("the domain of patch ") + which + " is not finite"};
  if (width > 0 && height > 0) return {};
  return {StatusCode::invalid_argument,
          std::string("the domain of patch ") + which + " is empty or reversed: " + text(width) + " x " + text(height)};
}

}}  // namespace tessera::abi_0_1
