#pragma once
// Surfaces at a distance from others.

#include "io/step/step_geometry.h"
#include "tessera/nurbs_surface.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// Moves a plane, cylinder, cone, sphere or torus along its normal. Errors: unsupported (a radius that is not
/// positive).
Result<StepElementary> offset_by(const StepElementary& of, double distance);
/// Fits the surface at a distance along the normal, within `tolerance`, as sampled. Errors: those of to_bezier().
Result<FaceSurface> offset_by(const BSplineSurface& of, double distance, double tolerance);

}}  // namespace tessera::abi_0_1
