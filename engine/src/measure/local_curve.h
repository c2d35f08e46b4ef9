#pragma once
// A monotone curve in the parameters of one patch, and bounds of it at complex arguments.

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "measure/centred_power.h"
#include "tessera/geometry.h"
#include "trim/plane_bezier.h"

namespace tessera { inline namespace abi_0_1 {

/// Numbers between two ends.
struct ScalarRange {
  double lower, upper;
  bool has_zero() const { return lower <= 0 && upper >= 0; }
  double magnitude() const { return std::max(std::abs(lower), std::abs(upper)); }
};

/// A point of a curve and the derivatives by its parameter.
struct LocalCurvePoint {
  double u, v, du, dv;
};

/// A Bezier curve over [0, 1], monotone in u and in v, in the parameters [0, 1]^2 of a patch.
class LocalCurve {
 public:
  /// Makes the straight line between two points.
  LocalCurve(const ParameterPoint& from, const ParameterPoint& to);
  /// Maps a curve from the parameters in which the patch covers `patch`.
  LocalCurve(const PlaneBezier& curve, const Domain& patch);

  const ParameterPoint& start() const { return start_; }
  const ParameterPoint& end() const { return end_; }
  int degree() const { return degree_; }
  /// How far at() and the ends are off the curve in u and in v, from rounding.
  double rounding() const { return rounding_; }
  LocalCurvePoint at(double t) const;
  std::pair<LocalCurve, LocalCurve> halves() const;
  /// Ranges of the derivatives.
  struct Slopes {
    ScalarRange u, v;
  };
  Slopes slopes() const;

 private:
  friend class CurveSeries;
  using Values = std::array<double, max_order>;

  int degree_ = 1;
  bool is_rational_ = false;
  double rounding_ = 0x1p-52;
  ParameterPoint start_{}, end_{};
  Values u_{}, v_{}, w_{};  ///< homogeneous, relative to start_
};

/// Bounds of a curve for parameters z in the ellipse with foci 0 and 1 that ellipse_reach() gives.
class CurveSeries {
 public:
  explicit CurveSeries(const LocalCurve& curve);

  struct Disc {
    double u, v;     ///< the largest |u(z) - centre().u| and |v(z) - centre().v|; infinite where it may have a pole
    double v_speed;  ///< the largest |v'(z)|
  };
  const ParameterPoint& centre() const { return centre_; }
  Disc disc(double reach) const;

 private:
  int degree_;
  ParameterPoint centre_;
  LocalCurve::Values u_{}, v_{}, w_{};  ///< power coefficients; u and v relative to the centre
};

}}  // namespace tessera::abi_0_1
