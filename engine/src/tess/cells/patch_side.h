#pragma once
// The borders of a patch, in the order of the ring of triangles along them.

#include <array>
#include <cstdint>

#include "tessera/geometry.h"

namespace tessera { inline namespace abi_0_1 {

/// The four borders of a patch, counter-clockwise around its parameters from (0,0): v = 0, u = 1, v = 1, u = 0.
enum class Side : std::uint8_t { v0, u1, v1, u0 };
inline constexpr std::array<Side, 4> all_sides{Side::v0, Side::u1, Side::v1, Side::u0};
constexpr bool runs_along_u(Side side) { return side == Side::v0 || side == Side::v1; }
/// Whether the ring runs against the parameter along a border.
constexpr bool is_backward(Side side) { return side == Side::v1 || side == Side::u0; }
constexpr Side opposite(Side side) { return static_cast<Side>((static_cast<int>(side) + 2) % 4); }
constexpr Edge edge_of(Side side) {
  constexpr Edge edges[] = {Edge::v0, Edge::u1, Edge::v1, Edge::u0};
  return edges[static_cast<int>(side)];
}

}}  // namespace tessera::abi_0_1
