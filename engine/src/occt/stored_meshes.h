#pragma once
// Puts triangulations into the faces of a shape, and polygons into their edges.

#include <opencascade/Poly_Triangulation.hxx>

#include <span>

#include "occt/edge_polygons.h"
#include "tessera/occt.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// Replaces the triangulations of faces, and the polygons that edges have on them. All is made before anything is
/// replaced, so that an error leaves the shape as it was.
///
/// `made`: `[face]`; a face of null loses what it has. `polygons`: edges get their representations. Errors:
/// invalid_argument (a face, or an edge of it, is locked). May throw Standard_Failure, with the shape as it was.
Status store(const OcctShape& sources, std::span<const opencascade::handle<Poly_Triangulation>> made,
             std::span<const EdgePolygon> polygons);

}}  // namespace tessera::abi_0_1
