#pragma once
// An edge's curve in a face's parameters, in the form of our splines.

#include <opencascade/Geom2d_Curve.hxx>

#include "io_occt/face_surface.h"
#include "tessera/curve.h"
#include "tessera/status.h"

namespace tessera::inline abi_0_1 {

/// The part of `curve` over `range` in our parameters, in the other direction if `reversed`. The curve's own spline where
/// the parameters are equal, or where it is straight along one of them; else cubics within `tolerance`. Errors: those of
/// Curve. May throw Standard_Failure.
Result<Curve> trim_curve(const opencascade::handle<Geom2d_Curve>& curve, const Interval& range, bool reversed,
                         const Reparametrization& parameters, double tolerance);

}  // namespace tessera::inline abi_0_1
