#pragma once
// The mesh of what trimming loops keep of a face.

#include <cstddef>
#include <span>

#include "tessera/convert.h"
#include "tessera/mesh.h"
#include "tessera/status.h"
#include "trim/loop_repair.h"

namespace tessera::inline abi_0_1 {

/// A mesh of a trimmed face.
struct TrimmedFaceMesh {
  /// Positions relative to the origin, parameters of the patches, a patch for each triangle, triangles. Patches have
  /// vertices of their own; those on a common side have the same bits.
  Mesh mesh;
  /// Every point of the mesh lies within this of the kept part of the face, and the other way round.
  double bound = 0;
  std::size_t whole_patches = 0, cut_patches = 0, patches_left_out = 0;
};

/// Makes a mesh that keeps a tolerance.
///
/// - `grid`: the face's patches. `loops`: cut at its breakpoints.
/// - `tolerance`: a distance above 0, for bound().
/// - `origin`: positions are relative to it.
///
/// Proof of the bound:
/// 1. A triangle with its corners on a patch lies within f of it: tess/bounds/chord_bound.h, by its own parameter box.
///    Each point of the triangle is near a point of the patch at parameters in the triangle, and the other way round.
/// 2. The triangles cover the polygon of the chords, once: PolygonTriangles, by exact signs.
/// 3. A point of the polygon outside of the loops lies in a sliver between a chord and its curve. So does a point
///    within the loops outside of the polygon. Both are within e of a point on the other's border: PieceChords.
/// 4. Vertices are rounded by at most r: f64_vertex_rounding(). So the bound is f + e + r, each its largest.
///
/// Errors: invalid_argument (a tolerance that rounding does not leave, or that needs more than 4096 segments across a
/// patch; index = the patch), unsupported (loops that cross themselves or each other; index = the patch),
/// out_of_memory.
Result<TrimmedFaceMesh> mesh_trimmed_face(const PatchGrid& grid, const RepairedLoops& loops, double tolerance,
                                          const Vec3& origin);

}  // namespace tessera::inline abi_0_1
