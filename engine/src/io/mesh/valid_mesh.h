#pragma once
// Checks that files can hold a mesh.

#include <cstdint>

#include "io/mesh/mesh_pieces.h"
#include "tessera/mesh.h"
#include "tessera/mesh_assembly.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// Checks that the mesh has vertices, its lengths agree, its indices, parts and colours are in range and its numbers
/// fit float in the model's space. Errors: count_mismatch, invalid_argument, non_finite (index = the place).
Status validate(const Mesh& mesh);
/// Checks a piece of a mesh: that it is valid, or has nothing, and that it has the attributes of the totals. Errors: as
/// above, count_mismatch.
Status validate_piece(const Mesh& piece, const MeshTotals& totals);
/// Checks that the patches of all faces plus `first_patch` are at most 4,294,967,295. Errors: unsupported.
Status check_patches(const Mesh& mesh, std::uint64_t first_patch);
/// Checks the meshes of all shapes that are not empty, and the instances. Errors: as above (index = the shape or
/// instance).
Status validate(const MeshAssembly& assembly);

}}  // namespace tessera::abi_0_1
