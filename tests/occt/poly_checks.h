#pragma once
// Triangulations that shapes hold, checked against what OpenCASCADE's consumers of them expect.

#include <opencascade/Poly_Triangulation.hxx>
#include <opencascade/TopoDS_Shape.hxx>

#include <cstddef>
#include <string>
#include <vector>

#include "tessera/occt_mesh.h"

namespace tessera::test {

/// The diagonal of a shape's box, whatever triangulations it has.
double size_of(const TopoDS_Shape& shape);

/// Findings in the triangulations of a shape.
struct PolyFacts {
  std::size_t faces = 0, nodes = 0, triangles = 0, polygons = 0;
  std::vector<std::string> wrong;  ///< the first few violations, one sentence each
  std::size_t violations = 0;
  double worst_node = 0;  ///< the largest distance of a node from its face's point of its parameters
  double worst_edge = 0;  ///< of a polygon's node from the edge's own curve at its parameter
};

/// Checks all triangulations and polygons after triangulate(). Faces that the report names lack edges or loops are
/// checked without their edges.
PolyFacts check_polys(const TopoDS_Shape& shape, const OcctMeshReport& report);

/// The triangles of a file that StlAPI_Writer writes of a shape.
struct StlFacts {
  std::size_t triangles = 0;
  std::size_t open_sides = 0;  ///< sides, by the positions of their ends, of a single triangle
  double volume = 0;           ///< that the triangles enclose, by the divergence theorem
  double area = 0;
};
StlFacts stl_facts(const TopoDS_Shape& shape);

/// The triangulations of all faces of a shape, wherever they stand; null where there is none.
std::vector<opencascade::handle<Poly_Triangulation>> triangulations_of(const TopoDS_Shape& shape);

}  // namespace tessera::test
