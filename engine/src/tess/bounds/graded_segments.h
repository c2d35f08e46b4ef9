#pragma once
// Finds segments that lie where a patch bends.

#include <optional>

#include "tess/bounds/cell_limits.h"
#include "tess/cells/segments.h"

namespace tessera { inline namespace abi_0_1 {

/// Whether any segments with fewer cells may keep the limits of distances, by what quarters need.
bool may_have_fewer(const CellLimits& limits, double cells);

/// Returns segments that keep the limits with fewer cells than the `uniform` ones, by a rate of its own in each eighth
/// of a parameter; empty if none are found. They never cross the middle if the limits are for halves.
std::optional<PatchSegments> graded_segments(const CellLimits& limits, Rates uniform);

}}  // namespace tessera::abi_0_1
