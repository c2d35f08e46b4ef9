#pragma once
// The borders of a patch, in the order of the ring of triangles along them.

#include <array>
#include <cstdint>
#include <utility>

#include "tessera/geometry.h"

namespace tessera { inline namespace abi_0_1 {

inline constexpr std::array<Side, 4> all_sides{Side::v0, Side::u1, Side::v1, Side::u0};
constexpr bool runs_along_u(Side side) { return side == Side::v0 || side == Side::v1; }
/// Whether the ring runs against the parameter along a border.
constexpr bool is_backward(Side side) { return side == Side::v1 || side == Side::u0; }
constexpr Side opposite(Side side) { return static_cast<Side>((static_cast<int>(side) + 2) % 4); }
/// Whether the parameter across a border is 1 on it, rather than 0.
constexpr bool is_far(Side side) { return side == Side::u1 || side == Side::v1; }

/// Returns the member of a value with `u` and `v` that belongs to the parameter along a border, or across it.
template <class T>
constexpr auto& along_side(Side side, T& both) {
  return runs_along_u(side) ? both.u : both.v;
}
template <class T>
constexpr auto& across_side(Side side, T& both) {
  return runs_along_u(side) ? both.v : both.u;
}
/// Returns the range of the parameter along a border, and the border's value of the one across.
constexpr std::pair<double, double> range_along(Side side, const Domain& domain) {
  return runs_along_u(side) ? std::pair(domain.u0, domain.u1) : std::pair(domain.v0, domain.v1);
}
constexpr double line_of(Side side, const Domain& domain) {
  const double lines[] = {domain.v0, domain.u1, domain.v1, domain.u0};
  return lines[static_cast<int>(side)];
}
/// Returns the point with these parameters along a border and across it.
constexpr ParameterPoint point_beside(Side side, double along, double across) {
  return runs_along_u(side) ? ParameterPoint{along, across} : ParameterPoint{across, along};
}
/// Returns the degree along a border of a net with `degree_u` and `degree_v`.
template <class T>
constexpr int degree_along(Side side, const T& net) {
  return runs_along_u(side) ? net.degree_u : net.degree_v;
}

}}  // namespace tessera::abi_0_1
