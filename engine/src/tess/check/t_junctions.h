#pragma once
// Counts vertices that lie inside an edge.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "tessera/geometry.h"

namespace tessera { inline namespace abi_0_1 {

/// Returns how many of the vertices at the ends of `edges` lie inside another edge: at most 1e-6 of its length plus
/// `rounding` (relative to its largest coordinate) beside it, and at least 1e-3 of its length from its ends.
std::size_t count_t_junctions(std::span<const Vec3> vertices, std::span<const std::array<std::uint32_t, 2>> edges,
                              double rounding);

}}  // namespace tessera::abi_0_1
