#pragma once
// Checks that every tessellation makes before it writes.

#include <span>

#include "tess/cells/patch_triangles.h"
#include "tessera/mesh.h"
#include "tessera/patch_set.h"

namespace tessera { inline namespace abi_0_1 {

/// The arrays of a mesh beside positions, patches and faces.
struct MeshArrays {
  bool normals = true, parameters = true, model_positions = false;
};
/// Returns a mesh with these arrays, filled with zeros by several threads. Throws std::bad_alloc.
Mesh empty_mesh(const MeshCapacity& capacity, const Vec3& origin, const MeshArrays& arrays = {});

/// Checks views that a mesh is written to. `f64`: positions in double are required and those in float are optional;
/// else there must be no positions in double. Errors: buffer_too_small, invalid_argument (no positions; a null
/// component; a stride below 1; views that are misaligned or share memory).
Status check_views(const MeshViews& out, const MeshCapacity& wanted, bool f64 = false);

/// check_views() for positions and normals alone, which must be those of a mesh of this size. Errors: as check_views(),
/// count_mismatch (more vertices).
Status check_updated_views(const MeshViews& out, const MeshCapacity& wanted, bool f64 = false);
/// Checks that there are no views of quads. Errors: invalid_argument.
Status check_no_quads(const MeshViews& out);

/// The error of a set without float Bernstein blocks: unsupported.
Status no_float_blocks();
/// Checks that the patches of a set still have the shapes that a plan was made for. Errors: stale (index = the first
/// patch of another shape).
Status check_shapes(const PatchSet& set, std::span<const PatchShape> planned);

}}  // namespace tessera::abi_0_1
