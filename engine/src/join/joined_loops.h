#pragma once
// The edges of matched curves, and the loops that use them.

#include <span>

#include "join/piece_groups.h"

namespace tessera { inline namespace abi_0_1 {

/// Returns the shape with one edge per group, with the divided loops that use them, and with the vertices that are in
/// use. `shape` is the one that the curves are of; shells stay. Failures go to `failure`, see SpaceCurve.
Shape with_joined_loops(const Shape& shape, const FreeCurves& free, std::span<const CurvePiece> pieces,
                        std::span<const PieceGroup> groups, UnionFind& vertices, Status& failure);

}}  // namespace tessera::abi_0_1
