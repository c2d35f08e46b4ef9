#pragma once
// Checks that files can hold a mesh.

#include "tessera/mesh.h"
#include "tessera/mesh_assembly.h"
#include "tessera/status.h"

namespace tessera::inline abi_0_1 {

/// Checks that the mesh has vertices, its lengths agree, its indices, parts and colours are in range and its numbers
/// fit float in the model's space. Errors: count_mismatch, invalid_argument, non_finite (index = the place).
Status validate(const Mesh& mesh);
/// Checks the meshes of all shapes that are not empty, and the instances. Errors: as above (index = the shape or
/// instance).
Status validate(const MeshAssembly& assembly);

}  // namespace tessera::inline abi_0_1
