#include "ray/border/nearest_root.h"

#include "ray/net/bounded_step.h"
#include "ray/net/seen_point.h"

namespace tessera { inline namespace abi_0_1 {

LeafRoot nearest_to_ray(const BezierPatch& patch, const SceneFrame& frame, const RayLine& line, std::uint32_t index,
                        double u, double v) {
  constexpr int most = 20;
  const auto at = [&](NetParameters point) {
    const FirstOrder there = first_order(patch, point.u, point.v, frame.centre);
    return FirstOrder{frame.scale * there.position, frame.scale * there.du, frame.scale * there.dv};
  };
  NetParameters best{u, v};
  FirstOrder point = at(best);
  NetValue f = seen(point, line);
  for (int step = 0; step < most; ++step) {
    const NetParameters next = bounded_step(f, best);
    const FirstOrder there = at(next);
    const NetValue value = seen(there, line);
    if (!(value.residual() < f.residual())) break;
    best = next, point = there, f = value;
  }
  LeafRoot root;
  root.patch = index;
  root.u = best.u, root.v = best.v;
  root.s = f.s(), root.residual = f.residual();
  root.has_point = true;
  root.position = point.position, root.du = point.du, root.dv = point.dv;
  return root;
}

}}  // namespace tessera::abi_0_1
