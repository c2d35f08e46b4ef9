#pragma once
// Vertices that lie on the inside of an edge.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "tessera/geometry.h"

namespace tessera::inline abi_0_1 {

/// Of the vertices at the ends of `edges`, how many lie inside another of them: off its line by at most 1e-6 of its
/// length, or by the `rounding` of its coordinates, a share of them, and at least 1e-3 of it from its ends.
std::size_t count_t_junctions(std::span<const Vec3> vertices, std::span<const std::array<std::uint32_t, 2>> edges,
                              double rounding);

}  // namespace tessera::inline abi_0_1
