#pragma once
// The law by which segments follow from the rates that are needed along a parameter.

#include <array>

#include "tess/cells/segments.h"

namespace tessera { inline namespace abi_0_1 {

/// The rates needed in the eighths of a parameter.
using RateNeeds = std::array<Segments::Fraction, Segments::parts>;

/// Returns segments with about the fewest that have at least these rates, which are at most max_rate. `parts_halves`:
/// none may cross the middle.
///
/// The patches at an edge have one law for the largest rates that any of them needs, so they agree. Needs that run the
/// other way lead to reversed segments.
Segments segments_for(const RateNeeds& needs, bool parts_halves);

}}  // namespace tessera::abi_0_1
