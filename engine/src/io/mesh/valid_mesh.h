#pragma once
// Checks that files can hold a mesh.

#include "tessera/mesh.h"
#include "tessera/status.h"

namespace tessera::inline abi_0_1 {

/// Checks that the mesh has vertices, its lengths agree, its indices and parts are in range and its numbers fit float
/// in the model's space. Errors: count_mismatch, invalid_argument, non_finite (index = the place).
Status validate(const Mesh& mesh);

}  // namespace tessera::inline abi_0_1
