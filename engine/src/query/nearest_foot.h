#pragma once
// The nearest point of a patch where the distance is known to be convex: Newton's method within a rectangle.

#include <cstdint>

#include "query/second_order.h"

namespace tessera { inline namespace abi_0_1 {

/// Parameters of a patch from (u0, v0) to (u1, v1); a line or a point if ends are equal.
struct PatchPart {
  double u0, u1, v0, v1;
};

/// A point of a patch, and its distance from the point of a query.
struct Foot {
  double u, v;
  Vec3 position;  ///< relative to the origin
  double distance;
  bool on_border;   ///< the foot is no perpendicular: the part ends there
  bool converged;   ///< the gradient along the part is zero, up to rounding
  bool is_farther;  ///< proven not to be nearer than `limit`: the rest is meaningless
};

/// Finds the nearest point of a part from a start. `point`: relative to the origin. `limit`: feet that are proven to be
/// farther are of no use; the proof takes the squared distance for convex over the part. `rounding`: of points.
/// `max_steps`: of Newton's method.
Foot nearest_foot(const SecondOrderPatch& patch, const Vec3& point, const PatchPart& part, double u, double v,
                  double limit, double rounding, int max_steps = 24);

}}  // namespace tessera::abi_0_1
