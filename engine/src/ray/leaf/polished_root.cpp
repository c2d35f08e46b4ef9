#include "ray/leaf/polished_root.h"

#include <algorithm>
#include <cmath>

#include "ray/leaf/leaf_search.h"
#include "ray/net/projected_net.h"
#include "ray/net/seen_point.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

using kernel::PolishJob;

}  // namespace

FirstOrder scene_point(const BezierPatch& patch, const SceneFrame& frame, const kernel::RayKernels& kernels, double u,
                       double v) {
  const FirstOrder at = first_order(patch, frame.centre, kernels, u, v);
  return {frame.scale * at.position, frame.scale * at.du, frame.scale * at.dv};
}

bool polish(const BezierPatch& patch, const SceneFrame& frame, const kernel::RayKernels& kernels, const RayLine& line,
            const RootStart& start, bool with_gain, LeafRoot& root) {
  double u = start.u, v = start.v;
  for (int step = 0; step < PolishJob::max_steps; ++step) {
    const FirstOrder at = scene_point(patch, frame, kernels, u, v);
    const NetValue f = seen(at, line);
    const double inverse = 1 / (f.xu * f.yv - f.xv * f.yu);
    const double du = -(f.x * f.yv - f.y * f.xv) * inverse, dv = -(f.y * f.xu - f.x * f.yu) * inverse;
    u += du, v += dv;
    // Written so that NaN fails.
    if (!(std::abs(u - start.u) <= start.reach_u && std::abs(v - start.v) <= start.reach_v && u >= start.u0 &&
          u <= start.u1 && v >= start.v0 && v <= start.v1))
      return false;
    if (std::max(std::abs(du), std::abs(dv)) > start.linear) continue;
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

/// The line misses the piece if each of the piece's points is off by more than the tolerance. The parameters of a point
/// within the tolerance lie within `gain * tolerance` of the root's; twice that also bounds the change of the gain.
BorderRoot polish_at_border(const BezierPatch& patch, const SceneFrame& frame, const kernel::RayKernels& kernels,
                            const RayLine& line, RootStart start, double tolerance, LeafRoot& root) {
  constexpr double beyond_border = static_cast<double>(kernel::RayLeaf::reach) - 0.5;
  const double u0 = start.u0, u1 = start.u1, v0 = start.v0, v1 = start.v1;
  const double margin_u = beyond_border * (u1 - u0), margin_v = beyond_border * (v1 - v0);
  start.u0 -= margin_u, start.u1 += margin_u, start.v0 -= margin_v, start.v1 += margin_v;
  if (!polish(patch, frame, kernels, line, start, true, root)) return BorderRoot::open;
  const double u = std::clamp(root.u, u0, u1), v = std::clamp(root.v, v0, v1);
  const double off_u = std::abs(root.u - u), off_v = std::abs(root.v - v);
  if (off_u == 0 && off_v == 0) return BorderRoot::root;
  const double apart = 2 * (tolerance + root.residual);
  if (off_u > root.gain_u * apart + parameter_rounding || off_v > root.gain_v * apart + parameter_rounding)
    return BorderRoot::beyond;
  const FirstOrder at = scene_point(patch, frame, kernels, u, v);
  const NetValue f = seen(at, line);
  if (!(f.residual() <= root.residual)) return BorderRoot::open;
  root.u = u, root.v = v;
  root.position = at.position, root.du = at.du, root.dv = at.dv;
  root.s = f.z;
  return set_gain(f, 1, 1, root) ? BorderRoot::root : BorderRoot::open;
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
                      .v1 = bounds.v1,
                      .linear = bounds.linear};
  for (std::size_t k = 0; k < kernel::PolishedRays::size; ++k)
    rays.state[k] = lanes >> k & 1u ? kernel::PolishedRays::asked : kernel::PolishedRays::idle;
  (patch.is_rational() ? kernels.packets->polish_low_rational : kernels.packets->polish_cubic)(job, rays, lanes);
}

}}  // namespace tessera::abi_0_1
