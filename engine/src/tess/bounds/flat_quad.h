#pragma once
// Patches that are flat quadrilaterals, whatever their parameters do inside.

#include <optional>

#include "tessera/bezier_patch.h"

namespace tessera::inline abi_0_1 {

/// How far a patch may lie from the flat convex quadrilateral of its corners: empty if that is more than rounding. Its
/// control points lie in that quadrilateral, and those of its borders on the sides. So the patch lies in it (convex hull), and
/// covers it (its border runs once around it): as two triangles do, and any others with vertices on the patch.
std::optional<double> flat_quad_deviation(const BezierPatch& patch);

}  // namespace tessera::inline abi_0_1
