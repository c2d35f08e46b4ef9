#pragma once
// The parts of meshes.

#include "tessera/mesh.h"
#include "tessera/status.h"

namespace tessera {

/// Whether the parts, if there are any, are runs one after the other that together are all triangles and quads. Errors:
/// invalid_argument (index = the part), count_mismatch.
Status check_parts(const Mesh& mesh);

}  // namespace tessera
