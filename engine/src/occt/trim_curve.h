#pragma once
// The curve of an edge in a face's parameters, as one of our splines.

#include <opencascade/Geom2d_Curve.hxx>

#include "exact/swept_surface.h"
#include "occt/curve_parameter.h"
#include "tessera/curve.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// A curve, and how its parameter follows from OpenCASCADE's.
struct TrimCurve {
  Curve curve;
  CurveParameter parameter;  ///< of OpenCASCADE's parameter
};

/// The part of `curve` over `range` in our parameters; reverses its direction if `reversed`. Uses the curve's own
/// spline if the parameters are equal, or if the curve is straight along one of them; otherwise cubics within
/// `tolerance` along each parameter. Circles and ellipses become rational arcs over their angles. Errors: those of
/// Curve. May throw Standard_Failure.
Result<TrimCurve> trim_curve(const opencascade::handle<Geom2d_Curve>& curve, const Interval& range, bool reversed,
                             const Reparametrization& parameters, const ParameterPoint& tolerance);

}}  // namespace tessera::abi_0_1
