#pragma once
// Points and first derivatives of spline curves and surfaces, fast: for searches that evaluate many places.

#include <array>
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

/// Evaluates a curve. Keeps the curve's arrays alive. Parameters outside of the domain are moved to its ends.
class FastCurve {
 public:
  explicit FastCurve(const Curve& curve);
  CurvePlace operator()(double t) const;
  Vec3 point(double t) const { return (*this)(t).point; }
  const Curve& curve() const { return curve_; }

 private:
  Curve curve_;
};

/// Evaluates a surface. Parameters outside of the domain are moved to its sides.
class FastSurface {
 public:
  explicit FastSurface(const BSplineSurface& surface);
  SurfacePlace operator()(double u, double v) const;
  const BSplineSurface& surface() const { return surface_; }

 private:
  BSplineSurface surface_;
};

}}  // namespace tessera::abi_0_1
