#pragma once
// The edges that bound a face, with their curves in its parameters.

#include <opencascade/Bnd_Box2d.hxx>
#include <opencascade/Geom2d_Curve.hxx>
#include <opencascade/TopoDS_Edge.hxx>
#include <opencascade/TopoDS_Face.hxx>
#include <vector>

#include "tessera/curve.h"

namespace tessera { inline namespace abi_0_1 {

/// An edge as its wire holds it.
struct BorderEdge {
  TopoDS_Edge edge;
  opencascade::handle<Geom2d_Curve> curve;  ///< null: the face states none, and it cannot be found
  Interval range = {};                      ///< of the curve, as OpenCASCADE states it
};

/// The edges of a wire that bound the face, in the order of a walk along it. If the wire is broken, the edges that the
/// walk does not reach come last.
struct BorderWire {
  std::vector<BorderEdge> edges;
  Bnd_Box2d box;         ///< of all its curves
  bool is_outer = true;  ///< as BRepTools::OuterWire() finds it: its box holds those of all others
};

/// The sources of a face's box and loops. OpenCASCADE projects edges onto planes each time that it is asked
/// for their curve there, so each is asked for once.
struct FaceBorder {
  TopoDS_Face face;  ///< forward: wires of a reversed face run the other way, and enclose the same region
  std::vector<BorderWire> wires;
  Bnd_Box2d box;  ///< of all curves that bound the face
  /// The largest tolerance that the face and its edges state, at least OpenCASCADE's own: shorter lengths are rounding
  /// to its users.
  double tolerance = 0;
  double vertex_tolerance = 0;  ///< the largest of all vertices, and at least `tolerance`
  double fit_tolerance = 0;     ///< see DescribedShape::fit_tolerance
};
/// Lists the border of a face that has a surface. May throw Standard_Failure.
FaceBorder face_border(const TopoDS_Face& face);

}}  // namespace tessera::abi_0_1
