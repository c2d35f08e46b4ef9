#pragma once
// The polygons of edges on the triangulations of their faces.

#include <opencascade/BRep_CurveRepresentation.hxx>
#include <opencascade/Poly_PolygonOnTriangulation.hxx>

#include <cstdint>
#include <span>
#include <vector>

#include "occt/face_triangulation.h"
#include "tessera/occt.h"
#include "tessera/patch_set.h"
#include "tessera/tessellation.h"

namespace tessera { inline namespace abi_0_1 {

/// The polygon of an edge on the triangulation of a face, or both polygons of a seam.
struct EdgePolygon {
  std::uint32_t edge = 0, face = 0;
  /// Nodes by growing parameters of the edge. The second one is that of the reversed edge at a seam, else null.
  opencascade::handle<Poly_PolygonOnTriangulation> first, second;
  opencascade::handle<BRep_CurveRepresentation> representation;  ///< what the edge holds of them
};

/// The polygons of all edges.
struct EdgePolygons {
  std::vector<EdgePolygon> polygons;   ///< by edges, then faces
  std::vector<std::uint32_t> lacking;  ///< faces, by growing number: an edge has none there, or a part of one
};

/// Makes the polygons of all edges of a shape. The deflection of a polygon is that of its face, or the largest distance
/// of its nodes from the edge's own curve if that is larger.
///
/// `on_edges`: as edge_vertices() lists them; `made`: `[face]`, from `nodes`. An edge that a face without
/// a triangulation has gets none there. Edges are shared among the threads of the caller's arena. Errors: cancelled,
/// internal (an exception of OpenCASCADE). May throw Standard_Failure.
Result<EdgePolygons> edge_polygons(const PatchSet& set, const FaceTriangulations& nodes,
                                   std::span<const opencascade::handle<Poly_Triangulation>> made, const Shape& shape,
                                   const OcctShape& sources, std::span<const EdgeVertex> on_edges,
                                   const Execution& execution);

}}  // namespace tessera::abi_0_1
