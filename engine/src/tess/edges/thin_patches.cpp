#include "tess/edges/thin_patches.h"

#include <algorithm>

#include "tess/edges/side_curve.h"

namespace tessera { inline namespace abi_0_1 {

bool is_thin(const BezierPatch& patch, Side side, double reach) {
  const bool along_u = runs_along_u(side);
  for (int i = 0; i <= patch.degree_u(); ++i)
    for (int j = 0; j <= patch.degree_v(); ++j)
      if (!(length(patch.point(i, j) - patch.point(along_u ? i : 0, along_u ? 0 : j)) <= reach)) return false;
  return true;
}

bool is_needle(const BezierPatch& patch, Side side, double reach) {
  const SideCurve along(patch, side);
  const Vec3 way = along.last() - along.first();
  const double squared = dot(way, way);
  return std::ranges::all_of(patch.points(), [&](const Vec3& p) {
    const double share = squared > 0 ? std::clamp(dot(p - along.first(), way) / squared, 0.0, 1.0) : 0;
    return length(p - (along.first() + share * way)) <= reach;
  });
}

}}  // namespace tessera::abi_0_1
