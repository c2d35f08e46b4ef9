#include "ray/polished_root.h"

#include <algorithm>
#include <cmath>

#include "ray/first_order.h"
#include "ray/leaf_search.h"
#include "ray/projected_net.h"
#include "ray/seen_point.h"

namespace tessera {
namespace {

using kernel::PolishJob;

Vec3 triple(const double* x) { return {x[0], x[1], x[2]}; }

/// In the scene's coordinates.
FirstOrder scene_point(const BezierPatch& patch, const SceneFrame& frame, const kernel::RayKernels& kernels, double u,
                       double v) {
  const double* const points = &patch.points().data()->x;
  const int m = patch.degree_u(), n = patch.degree_v();
  FirstOrder out;
  kernel::RayPoint at;
  if (std::max(m, n) <= 3 && patch.is_rational()) {
    kernels.low_rational_point(points, patch.weights().data(), m, n, &frame.centre.x, u, v, at);
    out = {triple(at.position), triple(at.du), triple(at.dv)};
  } else if (m == 3 && n == 3 && !patch.is_rational()) {
    kernels.cubic_point(points, &frame.centre.x, u, v, at);
    out = {triple(at.position), triple(at.du), triple(at.dv)};
  } else {
    out = first_order(patch, u, v, frame.centre);
  }
  return {frame.scale * out.position, frame.scale * out.du, frame.scale * out.dv};
}

}  // namespace

bool polish(const BezierPatch& patch, const SceneFrame& frame, const Leaf& leaf, const kernel::RayKernels& kernels,
            const RayLine& line, const kernel::RayRoot& proven, bool with_radius, LeafRoot& root) {
  const auto [start_u, start_v, reach_u, reach_v] = start_of(leaf, proven);
  double u = start_u, v = start_v;
  for (int step = 0; step < PolishJob::most_steps; ++step) {
    const FirstOrder at = scene_point(patch, frame, kernels, u, v);
    const NetValue f = seen(at, line);
    const double inverse = 1 / (f.xu * f.yv - f.xv * f.yu);
    const double du = -(f.x * f.yv - f.y * f.xv) * inverse, dv = -(f.y * f.xu - f.x * f.yu) * inverse;
    u += du, v += dv;
    // Written so that NaN fails.
    if (!(std::abs(u - start_u) <= reach_u && std::abs(v - start_v) <= reach_v && u >= leaf.u0 &&
          u <= leaf.u0 + leaf.du && v >= leaf.v0 && v <= leaf.v0 + leaf.dv))
      return false;
    if (std::max(std::abs(du), std::abs(dv)) > PolishJob::linear) continue;
    root.patch = leaf.patch;
    root.u = u, root.v = v;
    root.position = at.position + (du * at.du + dv * at.dv);
    root.du = at.du, root.dv = at.dv;
    root.has_point = true;
    root.s = f.z + (du * dot(line.direction, at.du) + dv * dot(line.direction, at.dv));
    root.residual = search_rounding(leaf.degree_u, leaf.degree_v, 0, 0);
    root.certified = true;
    return !with_radius || set_radius(f, root.residual, 1, 1, root);
  }
  return false;
}

}  // namespace tessera
