#pragma once
// A bicubic B-spline surface over uniform knots as OpenCASCADE has it.

#include <Geom_BSplineSurface.hxx>
#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TColgp_Array2OfPnt.hxx>

#include <cstddef>
#include <vector>

#include "tessera/geometry.h"

namespace tessera::bench {

/// The surface over [0, spans]^2 with the control points `[i][j]`, spans + 3 in each direction.
inline Handle(Geom_BSplineSurface) uniform_spline(const std::vector<Vec3>& net, int spans) {
  const int side = spans + 3, count = spans + 7;
  TColStd_Array1OfReal knots(1, count);
  TColStd_Array1OfInteger once(1, count);
  for (int k = 1; k <= count; ++k) knots.SetValue(k, k - 4), once.SetValue(k, 1);
  TColgp_Array2OfPnt poles(1, side, 1, side);
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j) {
      const Vec3& p = net[static_cast<std::size_t>(i * side + j)];
      poles.SetValue(i + 1, j + 1, gp_Pnt(p.x, p.y, p.z));
    }
  return new Geom_BSplineSurface(poles, knots, knots, once, once, 3, 3);
}

}  // namespace tessera::bench
