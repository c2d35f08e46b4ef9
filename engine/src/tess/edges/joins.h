#pragma once
// Which vertices of neighbouring patches are one.

#include "tess/plan/certified_plan.h"
#include "tessera/strided_view.h"

namespace tessera::inline abi_0_1 {

/// Borders of one edge, corners at their ends, and borders that are a point are joined to those of the patch that comes
/// first: all of them, or, with normals of the plan's mesh whose vertices are not shared, those along which no two normals
/// lie further apart than the angle, in radians.
VertexCopies find_joins(const PatchSet::Impl& set, const CertifiedPlan& plan, const SharedEdges& edges,
                        const Weld& weld, const View3<float>* normals, double angle);

}  // namespace tessera::inline abi_0_1
