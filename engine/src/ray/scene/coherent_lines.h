#pragma once
// Decides whether rays are traced as a packet.

#include <cstddef>

#include "ray/line/ray_line.h"

namespace tessera { inline namespace abi_0_1 {

/// Returns whether lines are worth a packet: there are enough, they pass near each other and run nearly the same way.
/// line(k) is line k of `count`.
template <class Line>
bool worth_a_packet(std::size_t count, const Line& line) {
  constexpr std::size_t least = 6;
  if (count < least) return false;
  const RayLine& first = line(0);
  for (std::size_t k = 1; k < count; ++k) {
    const RayLine& other = line(k);
    if (!(dot(first.direction, other.direction) > 0.99 && max_abs(first.start - other.start) < 0.2)) return false;
  }
  return true;
}

}}  // namespace tessera::abi_0_1
