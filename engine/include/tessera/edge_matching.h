#pragma once
// Edges of faces that no file joins: those of IGES, OBJ, G2 and JSON.
//
// Memory: results own theirs and share geometry with the arguments. Threads: any number of calls at once, if the
// functions of the surfaces allow it.

#include <span>

#include "tessera/model.h"
#include "tessera/status.h"

#pragma GCC visibility push(default)
namespace tessera { inline namespace abi_0_1 {

/// Joins edges that run side by side, so that faces share them.
///
/// - `shape`: passes check_topology(). Its edges of two and more uses stay as they are. Edges of one use are matched,
///   and so are the curves of loops that name no edges, and the sides of untrimmed faces, which get an outline.
/// - `distance`: how far points of one edge may be apart, in the shape's space, above 0. Shorter edges are matched only
///   within half of their extent.
///
/// Curves are divided at sharp corners, and where the end of another comes within the distance. Pieces whose ends are
/// near each other, and whose points are within the distance of each other's nearest points, as sampled, become one
/// edge, nearest pairs first. A third piece joins two that are an edge only within an eighth of the distance, so it
/// counts where three faces meet and not where a strip is as narrow as that. Pieces of one face may be one edge: seams,
/// and slits narrower than the distance. The two sides of a face that is as narrow stay apart: it would vanish. Points
/// of the ends become one vertex, in the middle of their box.
///
/// Result: the shape with the same faces, in their order.
/// - Each edge has the parameter of one of its curves, the leading one, which the geometry of the pieces alone decides,
///   whatever the order of faces. Others state by Coedge::parameter where they are nearest to it: within 1e-8 of the
///   edge's extent, or an eighth of their distance.
/// - An edge that is a point, such as a pole or an edge shorter than the distance whose ends have become one vertex, is
///   degenerate.
/// - Faces that are joined, and are in no solid's shell, form shells. Each closed one becomes a solid of its own.
///
/// Errors: invalid_argument (a distance that is not finite, or not above 0; ids), those of evaluate_jet() as "face 3
/// (rim): ..." (index = the face), out_of_memory. Memory: about 3 kB per edge. Time: O(n log n) for n edges, about 0.2
/// ms each.
Result<Shape> joined_edges(const Shape& shape, double distance);

/// Returns a distance for joined_edges() where nothing better is known: 1e-4 of the size of the faces' loops, the
/// diagonal of a box of 5 points per curve; 0 without faces. Edges of real IGES files are apart by up to 6e-5 of it.
/// Errors: invalid_argument (ids), those of evaluate_jet() as above.
Result<double> joining_distance(const Shape& shape);

/// Makes a shape of surfaces without edges, and joins them as above. Errors: as above.
Result<Shape> joined_shape(std::span<const ModelSurface> surfaces, double distance);

}}  // namespace tessera::abi_0_1
#pragma GCC visibility pop
