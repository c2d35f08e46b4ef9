#pragma once
// Curves and surfaces of OpenCASCADE along one parameter, as our splines.

#include <opencascade/Geom_Curve.hxx>
#include <opencascade/TColStd_Array1OfReal.hxx>
#include <opencascade/gp_XYZ.hxx>
#include <vector>

#include "exact/spline_line.h"
#include "tessera/curve.h"
#include "tessera/geometry.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

inline Vec3 vec3(const gp_XYZ& p) { return {p.X(), p.Y(), p.Z()}; }

/// Knots, and the pole (from 0) at each place.
struct PoleLine {
  int degree = 1;
  std::vector<double> knots;
  std::vector<int> poles;
};

/// One direction of a spline in OpenCASCADE: `flat` is its KnotSequence; the period is 0 if it has none.
struct PoleCircle {
  int degree = 1, pole_count = 2;
  double period = 0;
};
/// Unrolls a periodic spline over [from, to], with repeated poles on unclamped knots: no pole is computed.
PoleLine unrolled(const PoleCircle& circle, const TColStd_Array1OfReal& flat, const Interval& range);

/// Converts a curve exactly. Exceptions: offset curves and hyperbolas, which are fitted to within 1e-6 of their length.
/// May throw Standard_Failure.
Result<SplineLine> spline_line(const opencascade::handle<Geom_Curve>& curve, const Interval& range);

}}  // namespace tessera::abi_0_1
