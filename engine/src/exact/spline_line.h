#pragma once
// Curves of CAD files over an interval as NURBS: profiles of surfaces, and curves for themselves.

#include <optional>
#include <span>
#include <vector>

#include "exact/arcs.h"
#include "tessera/curve.h"
#include "tessera/geometry.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

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

/// Returns the line as a curve over its range, or over another one, cut to what the knots cover. Errors: those of
/// Curve.
Result<Curve> curve_of(const SplineLine& line, const std::optional<Interval>& range = {});

/// The straight line with these ends at the ends of the range.
SplineLine straight_line(const Vec3& start, const Vec3& end, const Interval& range);
/// The ellipse centre + cos(t) x + sin(t) y.
SplineLine ellipse_arcs(const Vec3& centre, const Vec3& x, const Vec3& y, const Interval& range);
/// The parabola vertex + t^2/(4 focal) x + t y.
SplineLine parabola_arc(const Vec3& vertex, const Vec3& x, const Vec3& y, double focal, const Interval& range);
/// The hyperbola centre + cosh(t) x + sinh(t) y, whose parameter is t at the ends of each arc, but not within.
SplineLine hyperbola_arcs(const Vec3& centre, const Vec3& x, const Vec3& y, const Interval& range);

/// Returns the distinct knots within a range, and its ends.
std::vector<double> breaks_of(std::span<const double> knots, const Interval& range);

/// Returns the part of a range that the knots of a spline cover. An end that equals a knot up to the rounding of a
/// period becomes that knot: otherwise a patch would lie between them.
Interval covered(std::span<const double> knots, int degree, const Interval& range);

}}  // namespace tessera::abi_0_1
