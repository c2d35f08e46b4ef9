#pragma once
// The lines where the faces of a mesh end.

#include <cstdint>
#include <span>

#include "tessera/mesh.h"

namespace tessera::render {

/// Returns the edges of triangles where a face ends, as triangles without area, which MeshDistance takes.
///
/// - `mesh`: triangles only.
/// - `faces`: the face of each triangle. Edges inside a face are left out, the seam of a closed one too.
///
/// Vertices at equal positions count as one. The result has no triangles if all faces are closed, as a sphere is.
/// Requires indices within the mesh.
Mesh face_borders(const Mesh& mesh, std::span<const std::uint32_t> faces);

}  // namespace tessera::render
