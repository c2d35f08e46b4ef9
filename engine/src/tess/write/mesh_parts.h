#pragma once
// The parts of meshes.

#include "base/for_wings.h"
#include "tessera/mesh.h"
#include "tessera/status.h"

namespace tessera {

/// Whether the parts, if there are any, are runs one after the other that together are all triangles and quads. Errors:
/// invalid_argument (index = the part), count_mismatch.
TESSERA_FOR_WINGS Status check_parts(const Mesh& mesh);

}  // namespace tessera
