#pragma once
// The curve of an edge in a face's parameters, as one of our splines.

#include <opencascade/Geom2d_Curve.hxx>

#include "io_occt/face_surface.h"
#include "tessera/curve.h"
#include "tessera/status.h"

namespace tessera::inline abi_0_1 {

/// The part of `curve` over `range` in our parameters; reverses its direction if `reversed`. Uses the curve's own
/// spline if the parameters are equal, or if the curve is straight along one of them; otherwise cubics within
/// `tolerance`. Errors: those of Curve. May throw Standard_Failure.
Result<Curve> trim_curve(const opencascade::handle<Geom2d_Curve>& curve, const Interval& range, bool reversed,
                         const Reparametrization& parameters, double tolerance);

}  // namespace tessera::inline abi_0_1
