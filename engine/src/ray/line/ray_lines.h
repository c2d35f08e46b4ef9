#pragma once
// The lines of up to 16 rays at a time, lanes = rays.

#include <array>
#include <span>

#include "kernel/ray/ray_kernels.h"
#include "ray/line/ray_line.h"

namespace tessera { inline namespace abi_0_1 {

/// Checks the rays of a turn and prepares their lines, by vectors if the machine has them.
class RayTurn {
 public:
  static constexpr std::size_t size = kernel::RayBundle::size;

  RayTurn(const SceneFrame& frame, const Box3& box, const kernel::RayKernels& kernels);

  /// Sets one to `size` rays.
  void set(std::span<const Ray> rays);
  /// Returns a flag for each ray that was set; further ones are meaningless.
  std::span<const bool> valid() const { return valid_; }
  /// Returns the line of line_of() if the ray is valid, else an empty one.
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

}}  // namespace tessera::abi_0_1
