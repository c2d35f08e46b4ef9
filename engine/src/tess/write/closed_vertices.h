#pragma once
// Writes what closed edges add to a mesh.

#include <optional>

#include "tess/cells/parameter_map.h"
#include "tess/plan/certified_plan.h"
#include "tessera/execution.h"
#include "tessera/mesh.h"

namespace tessera { inline namespace abi_0_1 {

/// Writes vertices and triangles that are inserted into whole patches, then the common positions of all vertices along
/// edges, and common normals where these lie within `crease_angle`. All patches must have been written. Errors:
/// cancelled.
Status write_closed(const PatchSet::Impl& set, const CertifiedPlan& plan, std::optional<double> crease_angle,
                    const ParameterMaps& maps, const MeshViews& out, const Execution& execution);

}}  // namespace tessera::abi_0_1
