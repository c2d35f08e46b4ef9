#pragma once
// Curves and surfaces of OpenCASCADE along one parameter, as our splines.

#include <opencascade/Geom_Curve.hxx>
#include <opencascade/TColStd_Array1OfReal.hxx>
#include <opencascade/gp_XYZ.hxx>
#include <optional>
#include <vector>

#include "io_occt/arcs.h"
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
  /// The part of [from, to] that the knots cover.
  Interval covered(const Interval& range) const;
};

/// One direction of a spline in OpenCASCADE: `flat` is its KnotSequence; the period is 0 if it has none.
struct PoleCircle {
  int degree = 1, pole_count = 2;
  double period = 0;
};
/// Unrolls a periodic spline over [from, to], with repeated poles on unclamped knots: no pole is computed.
PoleLine unrolled(const PoleCircle& circle, const TColStd_Array1OfReal& flat, const Interval& range);

/// A curve over an interval. Points may have weights (empty: none).
struct SplineLine {
  int degree = 1;
  std::vector<double> knots;
  std::vector<Vec3> points;
  std::vector<double> weights;
  Interval range;
  std::optional<Arcs> arcs;  ///< maps the caller's parameter, an angle, to ours; empty: they are equal
  double fit_error = 0;      ///< 0: exact

  double weight(std::size_t k) const { return weights.empty() ? 1 : weights[k]; }
};

/// The straight line with these ends at the ends of the range.
SplineLine straight_line(const Vec3& start, const Vec3& end, const Interval& range);
/// The ellipse centre + cos(t) x + sin(t) y.
SplineLine ellipse_arcs(const Vec3& centre, const Vec3& x, const Vec3& y, const Interval& range);

/// Converts a curve exactly. Exceptions: offset curves and hyperbolas, which are fitted to within 1e-6 of their length.
/// May throw Standard_Failure.
Result<SplineLine> spline_line(const opencascade::handle<Geom_Curve>& curve, const Interval& range);

}}  // namespace tessera::abi_0_1
