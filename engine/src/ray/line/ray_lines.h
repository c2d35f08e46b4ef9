#pragma once
// The lines of rays that come many at a time.

#include <array>
#include <span>

#include "kernel/ray/ray_kernels.h"
#include "ray/line/ray_line.h"

namespace tessera::inline abi_0_1 {

/// Rays of a turn, checked and made ready by vectors where the machine has them.
class RayTurn {
 public:
  static constexpr std::size_t size = kernel::RayBundle::size;

  RayTurn(const SceneFrame& frame, const Box3& box, const kernel::RayKernels& kernels);

  /// One to `size` rays.
  void set(std::span<const Ray> rays);
  /// For each ray that was set; further ones mean nothing.
  std::span<const bool> valid() const { return valid_; }
  /// That of line_of(), where the ray is valid; empty where it isn't.
  const RayLine& line(std::size_t k) const { return lines_[k]; }

 private:
  void set_one(const Ray& ray, std::size_t k);

  const SceneFrame& frame_;
  const Box3& box_;
  const kernel::RayKernels& kernels_;
  kernel::RayRoom room_;
  kernel::RayBundle bundle_;
  kernel::RayLines made_;
  std::array<RayLine, size> lines_;
  std::array<bool, size> valid_;
};

}  // namespace tessera::inline abi_0_1
