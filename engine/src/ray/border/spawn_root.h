#pragma once
// Secondary rays: decides whether a root of a patch stands for the point where the ray starts.

#include "ray/border/adjacency.h"
#include "ray/line/ray_query.h"
#include "ray/line/set_view.h"

namespace tessera { inline namespace abi_0_1 {

/// Decides this for a root on a line that leaves the surfaces within line.spawn of its origin, in the frame's
/// coordinates.
///
/// Let x* be the point of the patch nearest to the origin, near the root, and f the patch across the ray, with Jacobian
/// J at x*. Let eta = |J^-1| |f(x*)|, K a bound of the second derivatives of f and h = |J^-1| K eta.
/// 1. If the patch passes by, |f(x*)| is at most the offset.
/// 2. If h <= 1/2, Kantorovich's theorem (Deuflhard, Newton Methods for Nonlinear Problems, 2nd ed., sec. 2.1) gives
///    one root within 2 eta of x*, which is the origin's, and no other within 1 / (|J^-1| K), which is no less.
/// 3. An uncertified root is a part of the patch within the tolerance of the ray. It is the origin's if Newton's method
///    leads from it to that root; it is then settled if it is small or lies so near.
/// 4. If h is larger, the ray runs along the patch, or the parameters are degenerate as at a pole. Then all roots up to
///    sqrt(8 offset / K) count as one.
///
/// A root that is not the origin's on its own patch may be a neighbour's, met again from beyond their border. If it
/// reaches a border (root_places.h) of `borders`, and these are given, its place there is decided on the patch beyond,
/// and on the others around a vertex or pole, by its distance from the ray there.
OriginRoot decide_origin(const SetView& set, const Adjacency* borders, const SceneFrame& frame, const RayLine& line,
                         const LeafRoot& root);

}}  // namespace tessera::abi_0_1
