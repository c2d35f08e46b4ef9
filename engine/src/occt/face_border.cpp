#include "occt/face_border.h"

#include <opencascade/BRepTools.hxx>
#include <opencascade/BRepTools_WireExplorer.hxx>
#include <opencascade/BRep_CurveRepresentation.hxx>
#include <opencascade/BRep_ListIteratorOfListOfCurveRepresentation.hxx>
#include <opencascade/BRep_TEdge.hxx>
#include <opencascade/BRep_Tool.hxx>
#include <opencascade/BndLib_Add2dCurve.hxx>
#include <opencascade/Geom2dConvert.hxx>
#include <opencascade/Geom2d_BSplineCurve.hxx>
#include <opencascade/Geom2d_Line.hxx>
#include <opencascade/Geom2d_TrimmedCurve.hxx>
#include <opencascade/Geom_ConicalSurface.hxx>
#include <opencascade/Geom_CylindricalSurface.hxx>
#include <opencascade/Geom_Plane.hxx>
#include <opencascade/Geom_ToroidalSurface.hxx>
#include <opencascade/Precision.hxx>
#include <opencascade/TopoDS.hxx>
#include <opencascade/TopoDS_Iterator.hxx>
#include <opencascade/TopoDS_Vertex.hxx>
#include <opencascade/TopoDS_Wire.hxx>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "occt/kind_of.h"
#include "occt/plane_curve.h"
#include "occt/plane_spline.h"
#include "occt/relative_place.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

using opencascade::handle;

/// Whether the edge bounds its face: INTERNAL and EXTERNAL edges lie in a face, or beside it, without cutting it.
bool is_border(const TopoDS_Shape& edge) {
  return edge.Orientation() == TopAbs_FORWARD || edge.Orientation() == TopAbs_REVERSED;
}

/// The vertices where an edge starts and ends in its wire, regardless of places; null where it has none.
struct EdgeEnds {
  const void* start = nullptr;
  const void* end = nullptr;
};

/// Whether a walk along the edges, each of which ends where the next one starts, is the only one: each starts at a
/// vertex of its own.
bool is_simple(const std::vector<TopoDS_Edge>& edges, const std::vector<EdgeEnds>& ends) {
  std::vector<const void*> starts;
  starts.reserve(edges.size());
  for (std::size_t k = 0; k < edges.size(); ++k) {
    if (!ends[k].start || edges[k].Location() != edges[0].Location()) return false;
    starts.push_back(ends[k].start);
  }
  std::sort(starts.begin(), starts.end());
  return std::adjacent_find(starts.begin(), starts.end()) == starts.end();
}

/// Puts the edges of a closed wire in the order of a walk, from the first one, if they are stored in that order or
/// against it, as nearly all are; returns whether they are.
bool take_stored_order(std::vector<TopoDS_Edge>& edges, const std::vector<EdgeEnds>& ends) {
  if (edges.empty() || !is_simple(edges, ends)) return false;
  const std::size_t count = edges.size();
  bool along = true, against = true;
  for (std::size_t k = 0; k < count; ++k) {
    along = along && ends[k].end == ends[(k + 1) % count].start;
    against = against && ends[(k + 1) % count].end == ends[k].start;
  }
  if (!along && against) std::reverse(edges.begin() + 1, edges.end());
  return along || against;
}

/// Whether the edge states a curve in the parameters of the surface at its place.
bool has_curve(const TopoDS_Edge& edge, const handle<Geom_Surface>& surface, const TopLoc_Location& place) {
  const TopLoc_Location location = relative_place(place, edge.Location());
  const auto* const shape = static_cast<const BRep_TEdge*>(edge.TShape().get());
  for (BRep_ListIteratorOfListOfCurveRepresentation curve(shape->Curves()); curve.More(); curve.Next())
    if (curve.Value()->IsCurveOnSurface(surface, location)) return true;
  return false;
}

/// Whether edges at one place lead from vertex to vertex, the last one to the start.
bool is_chain(const std::vector<TopoDS_Edge>& edges, const std::vector<EdgeEnds>& ends) {
  for (std::size_t k = 0; k < edges.size(); ++k)
    if (!ends[k].end || ends[k].end != ends[(k + 1) % edges.size()].start || edges[k].Location() != edges[0].Location())
      return false;
  return !edges.empty();
}

bool is_finite(const Interval& range) {
  return !::Precision::IsInfinite(range.from) && !::Precision::IsInfinite(range.to);
}

/// Whether the curve of each edge ends where that of the next one starts, the last one's at the start, as far as a
/// period is longer.
bool meet_in_plane(const std::vector<BorderEdge>& edges) {
  std::vector<std::array<gp_Pnt2d, 2>> ends;
  Bnd_Box2d box;
  for (const BorderEdge& edge : edges) {
    if (edge.curve.IsNull() || !is_finite(edge.range)) return false;
    std::array<gp_Pnt2d, 2>& end = ends.emplace_back();
    const bool reversed = edge.edge.Orientation() == TopAbs_REVERSED;
    end[reversed] = edge.curve->Value(edge.range.from);
    end[!reversed] = edge.curve->Value(edge.range.to);
    box.Add(end[0]), box.Add(end[1]);
  }
  double u0 = 0, u1 = 0, v0 = 0, v1 = 0;
  box.Get(u0, v0, u1, v1);
  constexpr double near = 1e-3;
  for (std::size_t k = 0; k < ends.size(); ++k) {
    const gp_XY gap = ends[(k + 1) % ends.size()][0].XY() - ends[k][1].XY();
    if (!(std::abs(gap.X()) <= near * (u1 - u0) && std::abs(gap.Y()) <= near * (v1 - v0))) return false;
  }
  return true;
}

/// Adds what is between two places of a line, both included.
void add_line(const Geom2d_Line& line, const Interval& range, Bnd_Box2d& box) {
  box.Add(line.Value(range.from));
  box.Add(line.Value(range.to));
}

/// Reads the border of one face.
class BorderReader {
 public:
  explicit BorderReader(const TopoDS_Face& face) {
    out_.face = TopoDS::Face(face.Oriented(TopAbs_FORWARD));
    out_.tolerance = std::max(::Precision::Confusion(), BRep_Tool::Tolerance(out_.face));
    surface_ = BRep_Tool::Surface(out_.face, place_);
    plane_ = kind_of<Geom_Plane>(surface_);
    is_unbounded_ = plane_ || kind_of<Geom_CylindricalSurface>(surface_) || kind_of<Geom_ConicalSurface>(surface_) ||
                    kind_of<Geom_ToroidalSurface>(surface_);
  }

  FaceBorder read() {
    for (TopoDS_Iterator child(out_.face); child.More(); child.Next()) {
      if (child.Value().ShapeType() == TopAbs_WIRE) add_wire(TopoDS::Wire(child.Value()));
      if (child.Value().ShapeType() == TopAbs_VERTEX) meet(TopoDS::Vertex(child.Value()));
    }
    find_outer();
    out_.vertex_tolerance = std::max(out_.vertex_tolerance, out_.tolerance);
    return std::move(out_);
  }

 private:
  void add_wire(const TopoDS_Wire& wire) {
    BorderWire& out = out_.wires.emplace_back();
    std::vector<TopoDS_Edge> edges;
    std::vector<EdgeEnds> ends;
    const auto most = static_cast<std::size_t>(wire.NbChildren());
    edges.reserve(most);
    ends.reserve(most);
    for (TopoDS_Iterator child(wire); child.More(); child.Next()) {
      if (child.Value().ShapeType() != TopAbs_EDGE) continue;
      const TopoDS_Edge& edge = TopoDS::Edge(child.Value());
      const EdgeEnds met = meet(edge);
      if (is_border(edge)) {
        edges.push_back(edge);
        ends.push_back(met);
      } else {
        add_bounds(with_curve(edge), out.box);
      }
    }
    out.edges = take_stored_order(edges, ends) ? with_curves(edges) : in_chain(edges, ends);
    if (out.edges.empty()) out.edges = with_curves(walked(wire, edges));
    Bnd_Box2d box;
    for (const BorderEdge& edge : out.edges) add_bounds(edge, box);
    out.box.Add(box);
    out_.box.Add(box);
  }

  /// The edges of a wire that runs along a seam, say, in the order in which they are stored, or against it, if their
  /// curves follow each other; else none.
  std::vector<BorderEdge> in_chain(std::vector<TopoDS_Edge>& edges, std::vector<EdgeEnds>& ends) const {
    for (int order = 0; order < 2 && !edges.empty(); ++order) {
      if (is_chain(edges, ends))
        if (std::vector<BorderEdge> made = with_curves(edges); meet_in_plane(made)) return made;
      std::reverse(edges.begin() + 1, edges.end());
      std::reverse(ends.begin() + 1, ends.end());
    }
    return {};
  }
  std::vector<TopoDS_Edge> walked(const TopoDS_Wire& wire, const std::vector<TopoDS_Edge>& all) const {
    std::vector<TopoDS_Edge> edges;
    for (BRepTools_WireExplorer walk(wire, out_.face); walk.More(); walk.Next())
      if (is_border(walk.Current())) edges.push_back(walk.Current());
    if (all.size() == edges.size()) return edges;
    for (const TopoDS_Edge& edge : all) {
      const auto same = [&](const TopoDS_Edge& other) { return edge.IsEqual(other); };
      if (std::none_of(edges.begin(), edges.end(), same)) edges.push_back(edge);
    }
    return edges;
  }

  /// Takes account of tolerances.
  void meet(const TopoDS_Vertex& vertex) {
    out_.vertex_tolerance = std::max(out_.vertex_tolerance, BRep_Tool::Tolerance(vertex));
  }
  EdgeEnds meet(const TopoDS_Edge& edge) {
    out_.tolerance = std::max(out_.tolerance, BRep_Tool::Tolerance(edge));
    EdgeEnds ends;
    for (TopoDS_Iterator vertex(edge, false, false); vertex.More(); vertex.Next()) {
      if (vertex.Value().ShapeType() != TopAbs_VERTEX) continue;
      meet(TopoDS::Vertex(vertex.Value()));
      if (vertex.Value().Orientation() == TopAbs_FORWARD) ends.start = vertex.Value().TShape().get();
      if (vertex.Value().Orientation() == TopAbs_REVERSED) ends.end = vertex.Value().TShape().get();
    }
    if (edge.Orientation() == TopAbs_REVERSED) std::swap(ends.start, ends.end);
    return ends;
  }

  std::vector<BorderEdge> with_curves(const std::vector<TopoDS_Edge>& edges) const {
    std::vector<BorderEdge> out;
    out.reserve(edges.size());
    for (const TopoDS_Edge& edge : edges) out.push_back(with_curve(edge));
    return out;
  }
  BorderEdge with_curve(const TopoDS_Edge& edge) const {
    BorderEdge out{edge, {}, {0, 0}};
    if (plane_ && !has_curve(edge, surface_, place_)) out.curve = curve_on_plane(edge, *plane_, place_, out.range);
    if (!out.curve.IsNull()) return out;
    out.curve = BRep_Tool::CurveOnSurface(edge, out_.face, out.range.from, out.range.to);
    return out;
  }

  /// Adds the rectangle that holds an edge's curve. OpenCASCADE's own misses what a periodic spline has behind its
  /// seam.
  void add_bounds(const BorderEdge& edge, Bnd_Box2d& box) const {
    if (edge.curve.IsNull()) return;
    const auto& [from, to] = edge.range;
    if (const auto* const line = kind_of<Geom2d_Line>(edge.curve); line && is_unbounded_ && is_finite(edge.range))
      return add_line(*line, edge.range, box);
    const handle<Geom2d_Curve> whole = bare_curve(edge.curve);
    if (!whole->IsPeriodic() || !whole->IsKind(STANDARD_TYPE(Geom2d_BSplineCurve)) || !(from < to)) {
      // AddUVBounds() would project the edge onto the plane again.
      if (plane_) return BndLib_Add2dCurve::Add(edge.curve, from, to, 0, box);
      return BRepTools::AddUVBounds(out_.face, edge.edge, box);
    }
    const handle<Geom2d_BSplineCurve> part =
        Geom2dConvert::CurveToBSplineCurve(new Geom2d_TrimmedCurve(whole, from, to));
    if (part->IsPeriodic()) part->SetNotPeriodic();
    BndLib_Add2dCurve::Add(part, 0, box);
  }

  void find_outer() {
    std::size_t outer = 0;
    for (std::size_t k = 1; k < out_.wires.size(); ++k)
      if (holds(out_.wires[k].box, out_.wires[outer].box)) outer = k;
    for (std::size_t k = 0; k < out_.wires.size(); ++k) out_.wires[k].is_outer = k == outer;
  }
  static bool holds(const Bnd_Box2d& box, const Bnd_Box2d& other) {
    std::array<double, 4> a{}, b{};
    if (!box.IsVoid()) box.Get(a[0], a[1], a[2], a[3]);
    if (!other.IsVoid()) other.Get(b[0], b[1], b[2], b[3]);
    return a[0] <= b[0] && a[1] <= b[1] && a[2] >= b[2] && a[3] >= b[3];
  }

  FaceBorder out_;
  handle<Geom_Surface> surface_;
  const Geom_Plane* plane_ = nullptr;  ///< the surface, if it is one
  bool is_unbounded_ = false;          ///< whether its parameters end nowhere, or are periodic
  TopLoc_Location place_;              ///< of the surface
};

}  // namespace

FaceBorder face_border(const TopoDS_Face& face) { return BorderReader(face).read(); }

}}  // namespace tessera::abi_0_1
