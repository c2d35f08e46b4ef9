#pragma once
// The sides of a surface that is a face by itself, as edges.

#include "io/step/step_face.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// Adds the loop along the sides of the surface's domain, and their edges: one for two sides that are the same line,
/// and a degenerate one for a side that is a point. Errors: those of Curve.
Status add_outline(StepFaceResult& face, double tolerance);

}}  // namespace tessera::abi_0_1
