#pragma once
// Welding in the mesh: vertices that take the place of others.

#include "base/function_ref.h"
#include "tess/plan/certified_plan.h"
#include "tessera/execution.h"
#include "tessera/mesh.h"

namespace tessera::inline abi_0_1 {

/// Copies positions within a mesh that is written already, and gives the vertices of poles that welding made the normals
/// that they have where the border is a point. Those alone whose patch, or the one that they are taken from, is written
/// anew. Errors: cancelled.
Status write_welded(const Weld& weld, const CertifiedPlan& plan, const PatchSet::Impl& set, const MeshViews& out,
                    const Execution& execution, FunctionRef<bool(std::size_t patch)> is_written);

/// Copies normals of joined vertices, where each has memory of its own. As above.
Status write_joined_normals(const VertexCopies& joins, const CertifiedPlan& plan, const View3<float>& normals,
                            const Execution& execution, FunctionRef<bool(std::size_t patch)> is_written);

}  // namespace tessera::inline abi_0_1
