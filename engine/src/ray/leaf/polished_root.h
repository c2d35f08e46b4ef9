#pragma once
// Roots that are known in float, to the last digits of double.

#include "kernel/ray/ray_kernels.h"
#include "ray/leaf/leaf_nets.h"
#include "ray/scene/ray_query.h"

namespace tessera::inline abi_0_1 {

/// Where Newton's method begins in a patch, how far from there the root can be, and where it must lie.
struct RootStart {
  double u, v, reach_u, reach_v;
  double u0 = 0, u1 = 1, v0 = 0, v1 = 1;
  double linear = linear_step;  ///< the last step is at most that
};
/// Of what a kernel has proven of a piece of a patch; twice as far as it can be.
inline RootStart start_of(const Leaf& leaf, const kernel::RayRoot& proven) {
  const double u = proven.u, v = proven.v, radius_u = proven.radius_u, radius_v = proven.radius_v;
  return {leaf.u0 + (0.5 + u) * leaf.du,
          leaf.v0 + (0.5 + v) * leaf.dv,
          2 * radius_u * leaf.du,
          2 * radius_v * leaf.dv,
          leaf.u0,
          leaf.u0 + leaf.du,
          leaf.v0,
          leaf.v0 + leaf.dv,
          leaf.linear};
}

/// The root by Newton's method from there on, with the patch's point, and, `with_gain`, its gains. False where an iterate
/// leaves what is named.
bool polish(const BezierPatch& patch, const SceneFrame& frame, const kernel::RayKernels& kernels, const RayLine& line,
            const RootStart& start, bool with_gain, LeafRoot& root);

/// Where a root next to a border lies.
enum class BorderRoot : std::uint8_t {
  beyond,  ///< further off than the tolerance: the piece has none
  root,
  open,
};

/// Polishes a root that is `at_border`: by Newton's method on either side of it, as far as a kernel's bounds hold.
BorderRoot polish_at_border(const BezierPatch& patch, const SceneFrame& frame, const kernel::RayKernels& kernels,
                            const RayLine& line, RootStart start, double tolerance, LeafRoot& root);

/// Whether polish_side_by_side() takes roots of that patch.
bool polished_side_by_side(const BezierPatch& patch);
/// The same for the rays whose bits are set in `lanes`, with the numbers that each has alone; others are left as they are.
/// Lines, starts and reaches are set; of `bounds` the rectangle counts. For kernels that have packets.
void polish_side_by_side(const BezierPatch& patch, const SceneFrame& frame, const kernel::RayKernels& kernels,
                         const RootStart& bounds, kernel::PolishedRays& rays, unsigned lanes);

}  // namespace tessera::inline abi_0_1
