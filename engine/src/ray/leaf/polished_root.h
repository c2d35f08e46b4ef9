#pragma once
// Polishing of roots that are known in float to the last digits of double, for one ray or several of one patch.

#include "kernel/ray/ray_kernels.h"
#include "ray/leaf/leaf_nets.h"
#include "ray/line/first_order.h"
#include "ray/line/ray_query.h"

namespace tessera { inline namespace abi_0_1 {

/// The start of Newton's method in a patch, how far from there the root can be, and where it must lie.
struct RootStart {
  double u, v, reach_u, reach_v;
  double u0 = 0, u1 = 1, v0 = 0, v1 = 1;
  double linear = linear_step;  ///< limit of the last step
};
/// Returns the start for a root of a piece that a kernel has proven; its reach is twice the kernel's bound.
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

/// Finds the root by Newton's method, with the patch's point and, if `with_gain`, its gains. Returns false if an
/// iterate leaves the ranges of `start`.
bool polish(const BezierPatch& patch, const SceneFrame& frame, const kernel::RayKernels& kernels, const RayLine& line,
            const RootStart& start, bool with_gain, LeafRoot& root);

/// Returns a point of the patch in the scene's coordinates, with its derivatives.
FirstOrder scene_point(const BezierPatch& patch, const SceneFrame& frame, const kernel::RayKernels& kernels, double u,
                       double v);

/// The place of a root next to a border.
enum class BorderRoot : std::uint8_t {
  beyond,  ///< beyond by more than the tolerance: the piece has no root
  root,
  open,
};

/// Polishes a root that is `at_border`, by Newton's method on either side of the border, as far as a kernel's bounds
/// hold.
BorderRoot polish_at_border(const BezierPatch& patch, const SceneFrame& frame, const kernel::RayKernels& kernels,
                            const RayLine& line, RootStart start, double tolerance, LeafRoot& root);

/// Returns whether polish_side_by_side() takes roots of that patch.
bool polished_side_by_side(const BezierPatch& patch);
/// Polishes the rays whose bits are set in `lanes`, with the same numbers as each alone; other rays are unchanged.
/// Lines, starts and reaches must be set. Only the rectangle and `linear` of `bounds` are used. For kernels that have
/// packets.
void polish_side_by_side(const BezierPatch& patch, const SceneFrame& frame, const kernel::RayKernels& kernels,
                         const RootStart& bounds, kernel::PolishedRays& rays, unsigned lanes);

}}  // namespace tessera::abi_0_1
