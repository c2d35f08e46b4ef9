#pragma once
// Normals on collapsed edges, where r_u x r_v vanishes and the kernels leave zero.

#include "block/patch_set_impl.h"
#include "eval/grid_plan_impl.h"

namespace tessera {

/// Calls write(iu, iv, normal) for each sample of the grid that lies on a collapsed edge of the patch; the normal is the
/// limit, or zero where there is none (see unit_normal).
template <class Write>
void for_each_pole_normal(const GridPlan::Impl& plan, const BezierPatch& patch, EdgeMask collapsed, Write&& write) {
  if ((collapsed.bits & plan.edges.bits) == 0) return;
  for (std::size_t iu = 0; iu < plan.u.size(); ++iu) {
    const double u = plan.u[iu];
    const bool u_edge = (u == 0 && collapsed.has(Edge::u0)) || (u == 1 && collapsed.has(Edge::u1));
    if (!u_edge && !collapsed.has(Edge::v0) && !collapsed.has(Edge::v1)) continue;
    for (std::size_t iv = 0; iv < plan.v.size(); ++iv) {
      const double v = plan.v[iv];
      const bool v_edge = (v == 0 && collapsed.has(Edge::v0)) || (v == 1 && collapsed.has(Edge::v1));
      if (u_edge || v_edge) write(iu, iv, unit_normal(patch, u, v).direction);
    }
  }
}

}  // namespace tessera
