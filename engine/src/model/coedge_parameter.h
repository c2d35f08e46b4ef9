#pragma once
// The parameter of an edge and that of a loop's curve along it.

#include "base/internal_export.h"
#include "tessera/brep.h"
#include "tessera/curve.h"

namespace tessera { inline namespace abi_0_1 {

/// Returns the parameter of the loop's curve at the edge's parameter s, within the curve's domain.
TESSERA_INTERNAL_EXPORT double curve_parameter(const Coedge& coedge, const Curve& curve, double s);
/// Returns the edge's parameter at t of the loop's curve: the inverse of curve_parameter(), up to rounding.
TESSERA_INTERNAL_EXPORT double edge_parameter(const Coedge& coedge, const Curve& curve, double t);

}}  // namespace tessera::abi_0_1
