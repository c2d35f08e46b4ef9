#pragma once
// Bezier pieces of spline curves by an extraction that curves of equal knots share.

#include "convert/spline/extraction.h"
#include "tessera/convert.h"

namespace tessera { inline namespace abi_0_1 {

/// Returns the pieces of to_bezier(curve). `extraction`: that of the curve's knots and domain.
BezierPieces bezier_pieces(const Curve& curve, const Extraction& extraction);

}}  // namespace tessera::abi_0_1
