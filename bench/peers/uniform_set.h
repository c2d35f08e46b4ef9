#pragma once
// The patches of a bicubic B-spline surface over uniform knots.

#include <vector>

#include "support/synthetic_sets.h"
#include "tessera/convert.h"
#include "tessera/model.h"
#include "tessera/nurbs_surface.h"

namespace tessera::bench {

/// Returns the set of the surface over [0, spans]^2 with the control points `[i][j]`, spans + 3 in each direction.
inline PatchSet uniform_set(const std::vector<Vec3>& net, int spans) {
  std::vector<double> knots;
  for (int k = -3; k <= spans + 3; ++k) knots.push_back(k);
  const auto surface = test::value_of(BSplineSurface::polynomial(3, knots, 3, knots, net));
  const PatchGrid grid = test::value_of(to_bezier(surface));
  return test::value_of(make_patch_set({&grid, 1}));
}

}  // namespace tessera::bench
