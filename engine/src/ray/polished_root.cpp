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

bool polish(const BezierPatch& patch, const SceneFrame& frame, const kernel::RayKernels& kernels, const RayLine& line,
            const RootStart& start, bool with_gain, LeafRoot& root) {
  double u = start.u, v = start.v;
  for (int step = 0; step < PolishJob::most_steps; ++step) {
    const FirstOrder at = scene_point(patch, frame, kernels, u, v);
    const NetValue f = seen(at, line);
    const double inverse = 1 / (f.xu * f.yv - f.xv * f.yu);
    const double du = -(f.x * f.yv - f.y * f.xv) * inverse, dv = -(f.y * f.xu - f.x * f.yu) * inverse;
    u += du, v += dv;
    // Written so that NaN fails.
    if (!(std::abs(u - start.u) <= start.reach_u && std::abs(v - start.v) <= start.reach_v && u >= start.u0 &&
          u <= start.u1 && v >= start.v0 && v <= start.v1))
      return false;
    if (std::max(std::abs(du), std::abs(dv)) > PolishJob::linear) continue;
    root.u = u, root.v = v;
    root.position = at.position + (du * at.du + dv * at.dv);
    root.du = at.du, root.dv = at.dv;
    root.has_point = true;
    root.s = f.z + (du * dot(line.direction, at.du) + dv * dot(line.direction, at.dv));
    root.residual = search_rounding(patch.degree_u(), patch.degree_v(), 0, 0);
    root.certified = true;
    return !with_gain || set_gain(f, 1, 1, root);
  }
  return false;
}

bool polished_side_by_side(const BezierPatch& patch) {
  const int least = std::min(patch.degree_u(), patch.degree_v()), most = std::max(patch.degree_u(), patch.degree_v());
  return patch.is_rational() ? most <= 3 : least == 3 && most == 3;
}

void polish_side_by_side(const BezierPatch& patch, const SceneFrame& frame, const kernel::RayKernels& kernels,
                         const RootStart& bounds, kernel::PolishedRays& rays, unsigned lanes) {
  const Vec3& c = frame.centre;
  const PolishJob job{.points = &patch.points().data()->x,
                      .weights = patch.weights().data(),
                      .degree_u = patch.degree_u(),
                      .degree_v = patch.degree_v(),
                      .centre = {c.x, c.y, c.z},
                      .scale = frame.scale,
                      .u0 = bounds.u0,
                      .u1 = bounds.u1,
                      .v0 = bounds.v0,
                      .v1 = bounds.v1};
  for (std::size_t k = 0; k < kernel::PolishedRays::size; ++k)
    rays.state[k] = lanes >> k & 1u ? kernel::PolishedRays::asked : kernel::PolishedRays::idle;
  (patch.is_rational() ? kernels.packets->polish_low_rational : kernels.packets->polish_cubic)(job, rays, lanes);
}

}  // namespace tessera
