#pragma once
// Meshes that files can hold.

#include "tessera/mesh.h"
#include "tessera/status.h"

namespace tessera::inline abi_0_1 {

/// Whether the mesh has vertices, its lengths fit each other, its indices and parts are in range and its numbers fit
/// float in the model's space. Errors: count_mismatch, invalid_argument, non_finite (index = the place).
Status validate(const Mesh& mesh);

}  // namespace tessera::inline abi_0_1
