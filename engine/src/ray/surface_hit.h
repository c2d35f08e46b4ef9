#pragma once
// A point of a patch as a hit.

#include "ray/first_order.h"
#include "ray/set_view.h"
#include "tessera/ray_scene.h"

namespace tessera {

/// Sets kind, patch, surface, parameters, position, derivatives and normal, with its flag; leaves t and residual. `at`:
/// of the patch at (u,v) in [0,1]^2, derivatives in another unit of length perhaps, of which `unit` is the model's;
/// `size`: the model's, in that unit.
void set_surface_point(const SetView& set, double size, double unit, std::uint32_t patch, double u, double v,
                       const FirstOrder& at, Hit& hit);

}  // namespace tessera
