#pragma once
// Points and first derivatives of spline curves and surfaces, fast: for searches that evaluate many places.

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "tessera/curve.h"
#include "tessera/geometry.h"
#include "tessera/nurbs_surface.h"

namespace tessera { inline namespace abi_0_1 {

/// A point of a curve, and its derivative.
struct CurvePlace {
  Vec3 point, slope;
};

/// A point of a surface, and its derivatives.
struct SurfacePlace {
  Vec3 point, du, dv;
};

/// The basis functions of one direction of a spline, with the reciprocals that their recurrence needs.
class FastBasis {
 public:
  /// The knots must outlive the object.
  FastBasis(std::span<const double> knots, int degree, double from, double to);

  /// Writes the degree + 1 functions that are not zero at t, and their derivatives; moves t into [from, to]. Returns
  /// the index of the first.
  std::size_t evaluate(double t, double* values, double* slopes) const;

 private:
  std::size_t span_of(double t) const;

  std::span<const double> knots_;
  std::size_t degree_;
  double from_, to_;
  std::vector<double> reciprocals_;  ///< degree (degree + 1) / 2 for each span
};

/// Evaluates a curve.
class FastCurve {
 public:
  explicit FastCurve(const Curve& curve);
  CurvePlace operator()(double t) const;
  Vec3 point(double t) const { return (*this)(t).point; }
  const Curve& curve() const { return curve_; }

 private:
  Curve curve_;
  FastBasis basis_;
};

/// Evaluates a surface.
class FastSurface {
 public:
  explicit FastSurface(const BSplineSurface& surface);
  SurfacePlace operator()(double u, double v) const;

 private:
  BSplineSurface surface_;
  FastBasis in_u_, in_v_;
  std::vector<std::array<double, 4>> points_;  ///< homogeneous: times the weight, then the weight itself
};

}}  // namespace tessera::abi_0_1
