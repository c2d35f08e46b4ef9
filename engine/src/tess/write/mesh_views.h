#pragma once
// What every tessellation checks before it writes.

#include <span>

#include "tess/write/patch_triangles.h"
#include "tessera/mesh.h"
#include "tessera/patch_set.h"

namespace tessera::inline abi_0_1 {

/// A mesh with all attributes, zeros, of so many vertices, triangles and quads.
Mesh empty_mesh(const MeshCapacity& capacity, const Vec3& origin);

/// Quads are looked at if the capacity holds any. Errors: buffer_too_small; invalid_argument (no positions, a null
/// component, a stride below 1). `f64`: positions in double are required, those in float are not; else there must be none.
Status check_views(const MeshViews& out, const MeshCapacity& wanted, bool f64 = false);

/// Of positions and normals alone.
Status check_vertex_views(const MeshViews& out, const MeshCapacity& wanted, bool f64 = false);

/// Whether a set has as many patches as a plan. Errors: stale.
Status check_count(const PatchSet& set, std::size_t planned);
/// Whether the patches of a set are still those that a plan was made for. Errors: stale, of the first that is not.
Status check_shapes(const PatchSet& set, std::span<const PatchShape> planned);

}  // namespace tessera::inline abi_0_1
