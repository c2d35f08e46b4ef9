#pragma once
// Finds the root of a patch next to a given point of it.

#include <cstdint>

#include "ray/line/ray_query.h"
#include "tessera/bezier_patch.h"

namespace tessera { inline namespace abi_0_1 {

/// Returns the point of the patch nearest to the line, from (u,v) on by Newton's method in the square; not certified.
LeafRoot nearest_to_ray(const BezierPatch& patch, const SceneFrame& frame, const RayLine& line, std::uint32_t index,
                        double u, double v);

}}  // namespace tessera::abi_0_1
