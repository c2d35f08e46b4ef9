#pragma once
// Meshes in the caller's memory.

#include "c/objects.h"
#include "tessera/mesh.h"

namespace tessera { inline namespace abi_0_1 {

/// Reads a caller's mesh as views to write to. Errors: those of views; TSR_INVALID_ARGUMENT (triangles without memory).
CStatus mesh_views(const tsr_mesh* mesh, tsr_mesh& read, MeshViews& views);
/// Copies a caller's mesh. Errors: as above.
CStatus mesh_copy(const tsr_mesh* mesh, Mesh& copy);

}}  // namespace tessera::abi_0_1
