#pragma once
// Parameters of points of spline surfaces.

#include <memory>

#include "io/step/step_inverse.h"
#include "tessera/nurbs_surface.h"

namespace tessera { inline namespace abi_0_1 {

/// Makes the inverse of a spline, which is periodic where two opposite sides are nearer to each other than `tolerance`.
std::unique_ptr<SurfaceInverse> make_spline_inverse(BSplineSurface surface, double tolerance);

}}  // namespace tessera::abi_0_1
