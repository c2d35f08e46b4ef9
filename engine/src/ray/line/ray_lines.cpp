#include "ray/line/ray_lines.h"

#include "ray/line/lane_vectors.h"
#include "ray/line/ray_segment.h"

namespace tessera { inline namespace abi_0_1 {
RayTurn::RayTurn(const SceneFrame& frame, const Box3& box, const kernel::RayKernels& kernels)
    : frame_(frame), box_(box), kernels_(kernels) {
  const Box3 room = clipping_box(box);
  const Vec3 &c = frame.centre, &lower = room.lower, &upper = room.upper;
  room_ = {{c.x, c.y, c.z}, frame.scale, {lower.x, lower.y, lower.z}, {upper.x, upper.y, upper.z}};
}

void RayTurn::set(std::span<const Ray> rays) {
  if (kernels_.packets == nullptr) {
    for (std::size_t k = 0; k < rays.size(); ++k) set_one(rays[k], k);
    return;
  }
  for (std::size_t k = 0; k < size; ++k) {
    const Ray& ray = rays[k < rays.size() ? k : 0];
    put(ray.origin, bundle_.origin, k);
    put(ray.direction, bundle_.direction, k);
    bundle_.near[k] = ray.tnear, bundle_.far[k] = ray.tfar;
  }
  kernels_.packets->lines(bundle_, room_, made_);
  for (std::size_t k = 0; k < rays.size(); ++k) {
    const double spawn = rays[k].spawn_offset;
    if (!(made_.plain[k] > 0 && spawn == 0)) {
      set_one(rays[k], k);
      continue;
    }
    valid_[k] = true;
    RayLine& line = lines_[k];
    line.empty = !(made_.enter[k] <= made_.leave[k]);
    if (line.empty) continue;
    line.start = get(made_.start, k), line.direction = get(made_.direction, k);
    line.across[0] = get(made_.across[0], k), line.across[1] = get(made_.across[1], k);
    line.near = made_.near[k], line.far = made_.far[k];
    line.enter = made_.enter[k], line.leave = made_.leave[k];
    line.slack = made_.slack[k], line.spawn = 0;
    line.base = made_.base[k], line.shift = made_.shift[k], line.speed = made_.speed[k];
  }
}

void RayTurn::set_one(const Ray& ray, std::size_t k) {
  valid_[k] = tessera::is_valid(ray);
  lines_[k] = valid_[k] ? line_of(ray, frame_, box_) : RayLine{};
}

}}  // namespace tessera::abi_0_1
