#pragma once
// Curves of the plane of parameters as splines.

#include <opencascade/Geom2d_Curve.hxx>

#include "exact/spline_line.h"
#include "tessera/curve.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// The curve inside wrappers that change neither points nor parameters.
opencascade::handle<Geom2d_Curve> bare_curve(opencascade::handle<Geom2d_Curve> curve);

/// A curve over a range as a spline, with points (u, v, 0).
struct PlaneSpline {
  SplineLine line;   ///< circles and ellipses: arcs
  double shift = 0;  ///< whole periods of the curve: from its parameter to that of the line, unless that has arcs
};
/// Makes the spline of a curve over a range; it ends with the curve, if that ends before the range. Errors: unsupported
/// (the curve has no part in the range). May throw Standard_Failure.
Result<PlaneSpline> plane_spline(const opencascade::handle<Geom2d_Curve>& curve, const Interval& range);

/// Makes the line run from its end to its start over the same range.
void reverse(SplineLine& line);

}}  // namespace tessera::abi_0_1
