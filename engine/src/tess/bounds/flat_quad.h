#pragma once
// Recognises patches that are flat quadrilaterals, whatever their parameters do inside.

#include <optional>

#include "tessera/bezier_patch.h"

namespace tessera { inline namespace abi_0_1 {

/// Returns how far a patch may lie from the flat convex quadrilateral of its corners; empty if that is more than
/// rounding.
///
/// All control points lie in that quadrilateral, and those of the borders on its sides. So the patch lies in it (convex
/// hull) and covers it (its border runs once around it). Two triangles do the same, and so do any others with vertices
/// on the patch.
std::optional<double> flat_quad_deviation(const BezierPatch& patch);

}}  // namespace tessera::abi_0_1
