#pragma once
// Loops of surfaces whose patches have other parameters than the surface itself.

#include <span>
#include <vector>

#include "tessera/quadric.h"
#include "tessera/status.h"
#include "tessera/trim_loop.h"

namespace tessera { inline namespace abi_0_1 {

/// Returns loops of a quadric in the parameters of to_bezier(piece), of which `loops` has the canonical ones. Straight
/// lines along a parameter remain so, unless the loop names edges, along which each point must keep its parameter. All
/// else becomes cubics that are off by at most 1e-9 of the ranges, as sampled.
/// Errors: unsupported (a loop runs over more than 64 times the ranges of the piece; index = the loop), non_finite.
Result<std::vector<TrimLoop>> grid_loops(std::span<const TrimLoop> loops, const QuadricPiece& piece);

}}  // namespace tessera::abi_0_1
