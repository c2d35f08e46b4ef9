#pragma once
// The axis of a sphere whose face has edges through the poles.

#include <span>

#include "io/step/step_geometry.h"
#include "tessera/curve.h"

namespace tessera { inline namespace abi_0_1 {

/// Returns the sphere with another axis if a border runs through a pole between its ends, where it would have no angle:
/// the axis of a few that stays farthest from all borders. Otherwise the same sphere.
StepElementary off_poles(const StepElementary& sphere, std::span<const Curve* const> borders, double tolerance);

}}  // namespace tessera::abi_0_1
