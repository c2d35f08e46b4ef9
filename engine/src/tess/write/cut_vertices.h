#pragma once
// Writes the patches of a certified mesh that trimming loops cut.

#include <optional>

#include "tess/cells/parameter_map.h"
#include "tess/plan/certified_plan.h"
#include "tessera/execution.h"
#include "tessera/mesh.h"

namespace tessera { inline namespace abi_0_1 {

/// Writes vertices, triangles and patch numbers of all cut patches, after whole ones and their copies: vertices on the
/// border of a whole patch take its positions, and its normals where these lie within `crease_angle` all along it.
/// Errors: cancelled.
Status write_cut(const PatchSet::Impl& set, const CertifiedPlan& plan, std::optional<double> crease_angle,
                 const ParameterMaps& maps, const MeshViews& out, const Execution& execution);

}}  // namespace tessera::abi_0_1
