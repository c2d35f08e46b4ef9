#pragma once
// Copies vertices within a mesh, for welding and for joined normals.

#include "base/function_ref.h"
#include "tess/plan/certified_plan.h"
#include "tessera/execution.h"
#include "tessera/mesh.h"

namespace tessera { inline namespace abi_0_1 {

/// Copies positions within a written mesh, and gives the vertices of poles made by welding the normals that they have
/// where the border is a point. Limited to vertices whose patch, or the patch that they are copied from, `is_written`
/// anew. Errors: cancelled, out_of_memory.
Status write_welded(const VertexCopies& weld, const CertifiedPlan& plan, const PatchSet::Impl& set,
                    const MeshViews& out, const Execution& execution, FunctionRef<bool(std::size_t patch)> is_written);

/// Copies normals of joined vertices that are stored separately. Limited, and errors, as write_welded().
Status write_joined_normals(const VertexCopies& joins, const CertifiedPlan& plan, const View3<float>& normals,
                            const Execution& execution, FunctionRef<bool(std::size_t patch)> is_written);

}}  // namespace tessera::abi_0_1
