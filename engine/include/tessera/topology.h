#pragma once
// The shapes of a model: their faces placed, the coedges of their edges, and how far faces are apart along edges.
//
// Memory: results own theirs, arguments are not kept. Threads: any number of calls at once, if the functions of the
// model's surfaces allow it.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "tessera/model.h"
#include "tessera/status.h"

#pragma GCC visibility push(default)
namespace tessera { inline namespace abi_0_1 {

/// Checks all ids of a model, of vertices, edges, faces, solids, shapes, and the surfaces of instances; positions,
/// ranges and tolerances must be finite. Each loop must have one coedge per curve, or none. A coedge's parameter must
/// be monotone, in the coedge's direction, stated for the edge's range, and within the curve's domain there.
/// edge_uses(), closed_shells() and edge_gaps() make this check of their shape.
///
/// Errors: invalid_argument, as "shape 2 (nut): edge 7 ends at vertex 12, there are 12 vertices" (index = the shape or
/// instance).
Status check_topology(const Model& model);
/// Checks one shape. Errors: as above, as "shape 0 (nut): ...".
Status check_topology(const Shape& shape);

/// Returns the faces of all instances in the model's space, one instance after the other: what Model::surfaces holds if
/// there are instances.
///
/// Errors: invalid_argument (an instance of no shape; index = the instance). Memory: each face shares geometry, loops
/// and name with its shape.
Result<std::vector<ModelSurface>> placed_faces(std::span<const Shape> shapes, std::span<const Instance> instances);

/// Returns the loops that name the edges of a face: its trims, or its outline if it has no trims.
inline const std::vector<TrimLoop>& edge_loops(const ShapeFace& face) {
  return face.trims->empty() ? *face.outline : *face.trims;
}

/// Where a face uses an edge: edge_loops(shape.faces[face])[loop].coedges[curve].
struct EdgeUse {
  std::uint32_t face = 0;                                            ///< index into Shape::faces
  std::uint32_t loop = 0;                                            ///< index into the face's edge_loops()
  std::uint32_t curve = 0;                                           ///< index into the loop's curves
  friend bool operator==(const EdgeUse&, const EdgeUse&) = default;  ///< by all members
};

/// All coedges of a shape, by edges.
struct EdgeUses {
  std::vector<std::size_t> first;  ///< of each edge, the first of its uses; at the end, the number of all uses
  std::vector<EdgeUse> uses;       ///< by edges; of one edge, in the order of faces, loops and curves
  /// Returns the uses of one edge: two where two faces meet, and at a seam.
  std::span<const EdgeUse> operator[](std::size_t edge) const {
    return std::span(uses).subspan(first[edge], first[edge + 1] - first[edge]);
  }
};
/// Lists the coedges of each edge. Errors: those of check_topology(), out_of_memory.
Result<EdgeUses> edge_uses(const Shape& shape);

/// Tells for each shell whether it is closed: each edge of its faces, save degenerate ones, has an even number of
/// coedges in them. A shell without faces, or with a face that names no edges, is not.
/// Errors: those of edge_uses().
Result<std::vector<bool>> closed_shells(const Shape& shape);

/// Measures for each edge the largest distance of two faces' points at equal parameters of the edge, at both ends and
/// `samples` - 2 parameters evenly between. 0 for an edge of one coedge. A measurement, not a bound; lengths are those
/// of the shape's space.
///
/// Errors: invalid_argument (fewer than two samples), those of edge_uses() and evaluate_jet().
Result<std::vector<double>> edge_gaps(const Shape& shape, int samples = 9);

}}  // namespace tessera::abi_0_1
#pragma GCC visibility pop
