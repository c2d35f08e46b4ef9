#include "occt/unmet_edges.h"

#include <opencascade/BRep_Tool.hxx>
#include <opencascade/Poly_PolygonOnTriangulation.hxx>
#include <opencascade/Poly_Triangulation.hxx>
#include <opencascade/TopoDS.hxx>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "occt/shape_numbers.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

using opencascade::handle;

/// The polygons that the faces of an edge have along it.
struct PolygonUses {
  std::vector<double> parameters;  ///< of the first polygon
  std::size_t count = 0;
  bool differ = false;  ///< whether a use has no polygon, or other parameters
};

bool are_same(const std::vector<double>& a, const std::vector<double>& b) {
  if (a.size() != b.size() || a.empty()) return false;
  const double rounding = 1e-9 * std::abs(a.back() - a.front());
  return std::ranges::equal(a, b, [&](double x, double y) { return std::abs(x - y) <= rounding; });
}

std::vector<double> parameters_along(const TopoDS_Edge& edge, const handle<Poly_Triangulation>& on,
                                     const TopLoc_Location& place) {
  std::vector<double> out;
  if (on.IsNull()) return out;
  const handle<Poly_PolygonOnTriangulation>& polygon = BRep_Tool::PolygonOnTriangulation(edge, on, place);
  if (polygon.IsNull() || !polygon->HasParameters()) return out;
  for (int k = 1; k <= polygon->NbNodes(); ++k) out.push_back(polygon->Parameter(k));
  return out;
}

}  // namespace

UnmetEdges unmet_edges(const TopoDS_Shape& shape) {
  ShapeNumbers edges(ShapeNumbers::Places::differ);
  std::vector<PolygonUses> uses;
  UnmetEdges out;
  for_shapes(shape, TopAbs_FACE, [&](const TopoDS_Shape& face) {
    TopLoc_Location place;
    const handle<Poly_Triangulation> on = BRep_Tool::Triangulation(TopoDS::Face(face), place);
    bool differs = false;
    for_shapes(face, TopAbs_EDGE, [&](const TopoDS_Shape& shape_of_edge) {
      const TopoDS_Edge& edge = TopoDS::Edge(shape_of_edge);
      const bool bounds = edge.Orientation() == TopAbs_FORWARD || edge.Orientation() == TopAbs_REVERSED;
      if (!bounds || BRep_Tool::Degenerated(edge)) return;
      const std::size_t k = edges.add(edge);
      if (k == uses.size()) uses.emplace_back();
      PolygonUses& of = uses[k];
      std::vector<double> parameters = parameters_along(edge, on, place);
      const bool is_other = of.count > 0 ? !are_same(of.parameters, parameters) : parameters.empty();
      of.differ = of.differ || is_other, differs = differs || is_other;
      if (of.count++ == 0) of.parameters = std::move(parameters);
    });
    if (differs) out.faces.push_back(TopoDS::Face(face));
  });
  for (std::size_t k = 0; k < uses.size(); ++k)
    if (uses[k].differ || uses[k].count % 2 != 0) out.edges.push_back(TopoDS::Edge(edges[k].Oriented(TopAbs_FORWARD)));
  return out;
}

}}  // namespace tessera::abi_0_1
