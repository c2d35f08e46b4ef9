#pragma once
// Turns a point of a patch into a hit, for both modes.

#include "ray/line/first_order.h"
#include "ray/line/set_view.h"
#include "ray/scene/batch_layout.h"
#include "tessera/ray_scene.h"

namespace tessera { inline namespace abi_0_1 {

/// Sets kind, patch, surface and parameters; (u,v) are the patch's, in [0,1]^2. Returns the patch's part of the
/// surface's domain.
inline const Domain& set_place(const SetView& set, std::uint32_t patch, double u, double v, Hit& hit) {
  const PatchSource& source = set.source(patch);
  hit.kind = HitKind::hit;
  hit.patch = patch, hit.surface = source.surface;
  hit.patch_u = u, hit.patch_v = v;
  hit.u = source.domain.u_at(u), hit.v = source.domain.v_at(v);
  return source.domain;
}

/// Sets these, and position, derivatives and normal, with its flag, as far as `parts` names them; t and residual are
/// unchanged. `at`: the patch at (u,v), with derivatives perhaps in another unit of length; `unit`: that unit in the
/// model's; `size`: the model's size in that unit.
void set_surface_point(const SetView& set, double size, double unit, std::uint32_t patch, double u, double v,
                       const FirstOrder& at, Hit& hit, HitParts parts = {});

}}  // namespace tessera::abi_0_1
