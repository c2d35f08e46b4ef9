#pragma once
// Welding in the mesh: vertices that take the place of others.

#include "tess/certified_plan.h"
#include "tessera/execution.h"
#include "tessera/mesh.h"

namespace tessera {

/// Copies positions within a mesh that is written already, and gives the vertices of poles that welding made the normals
/// that they have where the border is a point. Errors: cancelled.
Status write_welded(const Weld& weld, const CertifiedPlan& plan, const PatchSet& set, const MeshViews& out,
                    const Execution& execution);

}  // namespace tessera
