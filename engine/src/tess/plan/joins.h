#pragma once
// Finds the vertices of neighbouring patches that are one.

#include "tess/cells/parameter_map.h"
#include "tess/plan/certified_plan.h"
#include "tessera/strided_view.h"

namespace tessera { inline namespace abi_0_1 {

/// Joins each border to the first border of its edge, with the corners at their ends, and each border that is a point.
/// `normals`: the normals of the plan's mesh before vertices are shared. A border is joined only if no two normals
/// along it differ by more than `angle`, in radians. Null: all borders are joined. `maps`: borders are joined only
/// where they have the same parameters of one surface; null: anyway.
VertexCopies find_joins(const PatchSet::Impl& set, const CertifiedPlan& plan, const SharedEdges& edges,
                        const VertexCopies& weld, const View3<float>* normals, double angle, const ParameterMaps* maps);

}}  // namespace tessera::abi_0_1
