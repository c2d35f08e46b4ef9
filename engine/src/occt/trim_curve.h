#pragma once
// The curve of an edge in a face's parameters, as one of our splines.

#include <functional>
#include <opencascade/Geom2d_Curve.hxx>
#include <vector>

#include "occt/face_surface.h"
#include "tessera/curve.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// A curve, and how its parameter follows from OpenCASCADE's.
struct TrimCurve {
  Curve curve;
  std::function<double(double)> parameter;  ///< of OpenCASCADE's parameter; monotone
  std::vector<double> breaks;               ///< OpenCASCADE's parameters at which `parameter` is not smooth, in order
  bool is_plain = false;                    ///< the parameters are equal; if reversed, their sum is that of the ends
};

/// The curve inside wrappers that change neither points nor parameters.
opencascade::handle<Geom2d_Curve> bare_curve(opencascade::handle<Geom2d_Curve> curve);

/// The part of `curve` over `range` in our parameters; reverses its direction if `reversed`. Uses the curve's own
/// spline if the parameters are equal, or if the curve is straight along one of them; otherwise cubics within
/// `tolerance` along each parameter. Circles and ellipses become rational arcs over their angles. Errors: those of
/// Curve. May throw Standard_Failure.
Result<TrimCurve> trim_curve(const opencascade::handle<Geom2d_Curve>& curve, const Interval& range, bool reversed,
                             const Reparametrization& parameters, const ParameterPoint& tolerance);

}}  // namespace tessera::abi_0_1
