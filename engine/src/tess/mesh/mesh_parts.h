#pragma once
// Checks the parts of meshes.

#include "base/internal_export.h"
#include "tessera/mesh.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// Checks that the parts of a mesh, if it has any, follow each other and cover all of its triangles and quads.
/// Errors: invalid_argument (a part that does not begin where the one before ends; index = the part), count_mismatch
/// (parts that are not all faces).
TESSERA_INTERNAL_EXPORT Status check_parts(const Mesh& mesh);

}}  // namespace tessera::abi_0_1
