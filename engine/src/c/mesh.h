#pragma once
// Meshes in the caller's memory.

#include "c/objects.h"
#include "tessera/mesh.h"
#include "tessera/mesh_assembly.h"

namespace tessera { inline namespace abi_0_1 {

/// Reads a caller's mesh as views to write to. Errors: those of views; TSR_INVALID_ARGUMENT (triangles without memory).
CStatus mesh_views(const tsr_mesh* mesh, tsr_mesh& read, MeshViews& views);
/// Copies a caller's mesh. Errors: as above.
CStatus mesh_copy(const tsr_mesh* mesh, Mesh& copy);
/// Copies a caller's mesh, with the origin and the parts of its set, if there is one. Errors: as above; those of sets.
CStatus named_copy(const tsr_mesh* mesh, const tsr_set* set, Mesh& copy);
/// Copies a mesh per shape of a model, null for those that nothing is seen of. Errors: as above, index = the shape;
/// TSR_INVALID_ARGUMENT (no shapes), TSR_COUNT_MISMATCH.
CStatus assembly_of(const Model& model, const tsr_mesh* const* meshes, const tsr_set* const* sets, std::size_t count,
                    MeshAssembly& made);

}}  // namespace tessera::abi_0_1
