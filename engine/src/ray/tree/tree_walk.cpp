#include "ray/tree/tree_walk.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ray/tree/box_padding.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Returns 1 / x, finite.
float inverse_of(double x) {
  constexpr float least = 1e-18f;
  const auto narrow = static_cast<float>(x);
  return 1 / (std::abs(narrow) < least ? std::copysign(least, narrow) : narrow);
}

}  // namespace

void start_walk(const RayLine& line, const BoxNodes& tree, kernel::TreeWalk& walk) {
  const Vec3 &o = line.start, &d = line.direction;
  walk.origin[0] = static_cast<float>(o.x), walk.inverse[0] = inverse_of(d.x);
  walk.origin[1] = static_cast<float>(o.y), walk.inverse[1] = inverse_of(d.y);
  walk.origin[2] = static_cast<float>(o.z), walk.inverse[2] = inverse_of(d.z);
  walk.near = static_cast<float>(line.enter) - box_pad, walk.far = far_of_walk(line.leave);
  walk.waiting = 0;
  if (!tree.empty()) walk.stack[walk.waiting++] = {0, walk.near};
}

void start_walk(std::size_t count, FunctionRef<const RayLine&(std::size_t)> line, const BoxNodes& tree,
                kernel::TreePacket& packet) {
  float near = std::numeric_limits<float>::infinity();
  for (std::size_t k = 0; k < kernel::TreePacket::size; ++k) {
    const RayLine& at = line(k < count ? k : 0);
    const Vec3 &o = at.start, &d = at.direction;
    packet.origin[0][k] = static_cast<float>(o.x), packet.inverse[0][k] = inverse_of(d.x);
    packet.origin[1][k] = static_cast<float>(o.y), packet.inverse[1][k] = inverse_of(d.y);
    packet.origin[2][k] = static_cast<float>(o.z), packet.inverse[2][k] = inverse_of(d.z);
    packet.near[k] = static_cast<float>(at.enter) - box_pad;
    packet.far[k] = k < count ? far_of_walk(at.leave) : -std::numeric_limits<float>::infinity();
    near = std::min(near, packet.near[k]);
  }
  packet.waiting = 0;
  if (!tree.empty()) packet.stack[packet.waiting++] = {0, (1u << count) - 1, near};
}

float far_of_walk(double s) { return static_cast<float>(s) + box_pad; }

}}  // namespace tessera::abi_0_1
