#pragma once
// Finds the vertices of neighbouring patches that are one.

#include "tess/plan/certified_plan.h"
#include "tessera/strided_view.h"

namespace tessera::inline abi_0_1 {

/// Joins borders of one edge, the corners at their ends, and borders that are a point to those of the patch that comes
/// first. `normals`: those of the plan's mesh before vertices are shared; then only borders are joined along which no
/// two normals differ by more than `angle`, in radians. Null: all are joined.
VertexCopies find_joins(const PatchSet::Impl& set, const CertifiedPlan& plan, const SharedEdges& edges,
                        const Weld& weld, const View3<float>* normals, double angle);

}  // namespace tessera::inline abi_0_1
