#pragma once
// The vertices and edges of a shape, with ids.

#include <opencascade/TopoDS_Edge.hxx>
#include <optional>
#include <vector>

#include "exact/arcs.h"
#include "occt/shape_numbers.h"
#include "occt/trim_curve.h"
#include "tessera/model.h"
#include "tessera/occt.h"

namespace tessera { inline namespace abi_0_1 {

/// The edges of a shape's faces in the order of TopExp::MapShapes, and their vertices. An edge is the same where shape
/// and location are.
class ShapeEdges {
 public:
  /// Reads the edges by all threads. Errors: cancelled, internal (an exception of OpenCASCADE). May throw
  /// Standard_Failure.
  static Result<ShapeEdges> make(const TopoDS_Shape& shape, const Execution& execution);

  /// The coedge of an edge of the shape, whose curve in a face is `trim`, made over the range `theirs`. Its edge is
  /// no_id if the curve does not run along the edge from end to end. `tolerance`: the length by which points may move
  /// along the edge, so that the relation of their parameters is simple.
  Coedge coedge(const TopoDS_Edge& edge, const TrimCurve& trim, const Interval& theirs, double tolerance) const;

  /// Moves vertices and edges into a shape of ours, and says what they are made of.
  void give_to(Shape& shape, OcctShape& sources) &&;

 private:
  /// How the parameter of an edge follows from OpenCASCADE's.
  struct Parameter {
    Interval theirs;
    std::optional<Arcs> arcs;  ///< empty: they are equal
  };
  ShapeEdges() = default;
  void read_edge(std::size_t k);
  std::uint32_t vertex_id(const TopoDS_Shape& vertex) const;

  ShapeNumbers edge_numbers_{ShapeNumbers::Places::differ}, vertex_numbers_{ShapeNumbers::Places::differ};
  std::vector<BrepVertex> vertices_;
  std::vector<BrepEdge> edges_;
  std::vector<Parameter> parameters_;
};

}}  // namespace tessera::abi_0_1
