#include "ray/polished_root.h"

#include <algorithm>
#include <cmath>

#include "ray/first_order.h"
#include "ray/leaf_search.h"
#include "ray/projected_net.h"

namespace tessera {
namespace {

constexpr int most_steps = 6;
constexpr double linear = 1e-9;  // steps up to that leave a square of it

/// In the scene's coordinates.
FirstOrder scene_point(const BezierPatch& patch, const SceneFrame& frame, const kernel::RayKernels& kernels, double u,
                       double v) {
  FirstOrder out;
  if (patch.degree_u() == 3 && patch.degree_v() == 3 && !patch.is_rational()) {
    kernel::RayPoint at;
    kernels.cubic_point(&patch.points().data()->x, &frame.centre.x, u, v, at);
    out = {{at.position[0], at.position[1], at.position[2]},
           {at.du[0], at.du[1], at.du[2]},
           {at.dv[0], at.dv[1], at.dv[2]}};
  } else {
    out = first_order(patch, u, v, frame.centre);
  }
  return {frame.scale * out.position, frame.scale * out.du, frame.scale * out.dv};
}

/// As the ray sees it.
NetValue seen(const FirstOrder& at, const RayLine& line) {
  const Vec3 from = at.position - line.start;
  NetValue f;
  f.x = dot(line.across[0], from), f.y = dot(line.across[1], from), f.z = dot(line.direction, from);
  f.xu = dot(line.across[0], at.du), f.xv = dot(line.across[0], at.dv);
  f.yu = dot(line.across[1], at.du), f.yv = dot(line.across[1], at.dv);
  return f;
}

}  // namespace

bool polish(const BezierPatch& patch, const SceneFrame& frame, const Leaf& leaf, const kernel::RayKernels& kernels,
            const RayLine& line, const kernel::RayRoot& proven, LeafRoot& root) {
  const double start_u = leaf.u0 + (0.5 + static_cast<double>(proven.u)) * leaf.du,
               start_v = leaf.v0 + (0.5 + static_cast<double>(proven.v)) * leaf.dv;
  // Twice as far as it can be.
  const double reach_u = 2 * static_cast<double>(proven.radius_u) * leaf.du,
               reach_v = 2 * static_cast<double>(proven.radius_v) * leaf.dv;
  double u = start_u, v = start_v;
  for (int step = 0; step < most_steps; ++step) {
    const FirstOrder at = scene_point(patch, frame, kernels, u, v);
    const NetValue f = seen(at, line);
    const double inverse = 1 / (f.xu * f.yv - f.xv * f.yu);
    const double du = -(f.x * f.yv - f.y * f.xv) * inverse, dv = -(f.y * f.xu - f.x * f.yu) * inverse;
    u += du, v += dv;
    // Written so that NaN fails.
    if (!(std::abs(u - start_u) <= reach_u && std::abs(v - start_v) <= reach_v && u >= leaf.u0 &&
          u <= leaf.u0 + leaf.du && v >= leaf.v0 && v <= leaf.v0 + leaf.dv))
      return false;
    if (std::max(std::abs(du), std::abs(dv)) > linear) continue;
    root.patch = leaf.patch;
    root.u = u, root.v = v;
    root.position = at.position + (du * at.du + dv * at.dv);
    root.du = at.du, root.dv = at.dv;
    root.has_point = true;
    root.s = f.z + (du * dot(line.direction, at.du) + dv * dot(line.direction, at.dv));
    root.residual = search_rounding(leaf.degree_u, leaf.degree_v, 0, 0);
    root.certified = true;
    return set_radius(f, root.residual, 1, 1, root);
  }
  return false;
}

}  // namespace tessera
