#pragma once
// Where the stored triangulations of a shape do not meet.

#include <opencascade/TopoDS_Edge.hxx>
#include <opencascade/TopoDS_Face.hxx>
#include <opencascade/TopoDS_Shape.hxx>
#include <vector>

namespace tessera { inline namespace abi_0_1 {

/// Edges along which triangulations do not meet.
struct UnmetEdges {
  std::vector<TopoDS_Edge> edges;
  std::vector<TopoDS_Face> faces;  ///< that have nodes elsewhere along an edge than another face there
};

/// Compares the polygons of all faces of a shape, wherever they stand, along each edge: they meet where an even number
/// of them have nodes at the same parameters. May throw Standard_Failure.
UnmetEdges unmet_edges(const TopoDS_Shape& shape);

}}  // namespace tessera::abi_0_1
