#include "occt/edge_polygons.h"

#include <opencascade/BRep_PolygonOnClosedTriangulation.hxx>
#include <opencascade/BRep_PolygonOnTriangulation.hxx>
#include <opencascade/BRep_Tool.hxx>
#include <opencascade/Geom2d_Curve.hxx>
#include <opencascade/Geom_Curve.hxx>
#include <opencascade/TopoDS.hxx>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include "exact/arcs.h"
#include "occt/guarded_calls.h"
#include "occt/relative_place.h"
#include "tessera/topology.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

using opencascade::handle;

constexpr std::size_t edges_per_maker = 8;

class PolygonMaker {
 public:
  PolygonMaker(const PatchSet& set, const FaceTriangulations& nodes, std::span<const handle<Poly_Triangulation>> made,
               const OcctShape& sources)
      : set_(set), nodes_(nodes), made_(made), sources_(sources) {}

  /// Makes room for the edges of one maker, as most of them are.
  void reserve() {
    all_.reserve(2 * edges_per_maker);
    stations_.reserve(64), points_.reserve(64), filled_.reserve(64);
  }

  /// Adds the polygons of an edge: all its vertices, by uses.
  void add(std::span<const EdgeVertex> of_edge) {
    const std::size_t known = all_.size();
    stations_.clear();
    for (const EdgeVertex& one : of_edge) stations_.push_back(one.s);
    std::ranges::sort(stations_);
    stations_.erase(std::ranges::unique(stations_).begin(), stations_.end());
    for (std::size_t begin = 0, end = 0; begin < of_edge.size(); begin = end) {
      while (end < of_edge.size() && of_edge[end].use == of_edge[begin].use) ++end;
      add_use(of_edge.subspan(begin, end - begin));
    }
    represent(known);
  }

  /// Takes the polygons of another one, whose edges follow.
  void append(PolygonMaker&& after) {
    std::ranges::move(after.all_, std::back_inserter(all_));
    lacking_.insert(lacking_.end(), after.lacking_.begin(), after.lacking_.end());
  }

  /// Looks for edges without a polygon: those that are points of the mesh get the node of a vertex there.
  EdgePolygons finish(const Shape& shape) && {
    const std::size_t known = all_.size();
    for (std::uint32_t face = 0; face < shape.faces.size(); ++face) {
      if (made_[face].IsNull()) continue;
      for (const TrimLoop& loop : edge_loops(shape.faces[face]))
        for (const Coedge& coedge : loop.coedges)
          if (!shape.edges[coedge.edge].degenerate && !has_polygon(coedge.edge, face, known))
            add_point(shape, coedge.edge, face, known);
    }
    represent(known);
    std::ranges::sort(lacking_);
    lacking_.erase(std::ranges::unique(lacking_).begin(), lacking_.end());
    return {std::move(all_), std::move(lacking_)};
  }

 private:
  /// Makes what edges hold of the polygons from the known ones on.
  void represent(std::size_t known) {
    for (EdgePolygon& of : std::span(all_).subspan(known)) {
      const TopLoc_Location place =
          relative_place(sources_.faces[of.face].face.Location(), sources_.edges[of.edge].edge.Location());
      if (of.second.IsNull())
        of.representation = new BRep_PolygonOnTriangulation(of.first, made_[of.face], place);
      else
        of.representation = new BRep_PolygonOnClosedTriangulation(of.first, of.second, made_[of.face], place);
    }
  }

  struct Point {
    double s;
    int node;
  };

  void add_use(std::span<const EdgeVertex> use) {
    const std::uint32_t edge = use[0].edge, face = set_.source(use[0].patch).surface;
    if (made_[face].IsNull()) return;
    points_.clear();
    for (const EdgeVertex& one : use) {
      const int node = nodes_.node(one.vertex);
      if (node > 0 && (points_.empty() || points_.back().s != one.s)) points_.push_back({one.s, node});
    }
    if (points_.empty()) return;
    fill();
    const handle<Poly_PolygonOnTriangulation> polygon = polygon_of(edge, face);
    // Uses are in the order of faces, so those of a seam follow each other.
    if (!all_.empty() && all_.back().edge == edge && all_.back().face == face) {
      if (all_.back().second.IsNull()) add_second(all_.back(), polygon);
    } else {
      all_.push_back({edge, face, polygon, {}, {}});
    }
  }

  /// Adds the stations that this use lacks but others have, at the nodes nearest to them, so that all uses have as
  /// many: a loop may leave the face just before the edge ends.
  void fill() {
    const double near = 1e-3 * (stations_.back() - stations_.front());
    filled_.clear();
    std::size_t next = 0;  // the first own point that is not before the station
    for (const double s : stations_) {
      while (next < points_.size() && points_[next].s < s) ++next;
      const bool is_own = next < points_.size() && points_[next].s == s;
      const double above = next < points_.size() ? points_[next].s - s : HUGE_VAL;
      const double below = next > 0 ? s - points_[next - 1].s : HUGE_VAL;
      if (is_own || std::min(above, below) <= near)
        filled_.push_back({s, points_[above <= below ? next : next - 1].node});
    }
    if (filled_.size() == 1) filled_.push_back(Point(filled_[0]));  // a short edge that is a point of the mesh
    points_.swap(filled_);
  }

  handle<Poly_PolygonOnTriangulation> polygon_of(std::uint32_t of, std::uint32_t face) {
    const OcctEdge& edge = sources_.edges[of];
    std::optional<Arcs> arcs;
    if (const std::optional<Interval>& angles = edge.parameter.arcs) arcs.emplace(angles->from, angles->to);
    const auto count = static_cast<int>(points_.size());
    const handle<Poly_PolygonOnTriangulation> polygon = new Poly_PolygonOnTriangulation(count, true);
    for (int k = 0; k < count; ++k) {
      const Point& at = points_[static_cast<std::size_t>(k)];
      polygon->SetNode(k + 1, at.node);
      polygon->SetParameter(k + 1, arcs ? arcs->angle(at.s) : at.s);
    }
    double from = 0, to = 0;
    BRep_Tool::Range(edge.edge, from, to);
    const double near = 1e-4 * (to - from);
    const bool is_point = points_[0].s == points_.back().s;
    if (is_point || polygon->Parameter(1) - from <= near) polygon->SetParameter(1, from);
    if (is_point || to - polygon->Parameter(count) <= near) polygon->SetParameter(count, to);
    if (polygon->Parameter(1) > from || polygon->Parameter(count) < to) lacking_.push_back(face);
    polygon->Deflection(std::max(made_[face]->Deflection(), distance(edge, face, *polygon)));
    return polygon;
  }

  /// Returns the largest distance of the nodes of a polygon from the edge's own curve; 0 if it has none.
  double distance(const OcctEdge& edge, std::uint32_t face, const Poly_PolygonOnTriangulation& polygon) const {
    TopLoc_Location place;
    double from = 0, to = 0;
    const handle<Geom_Curve> curve = BRep_Tool::Curve(edge.edge, place, from, to);
    if (curve.IsNull()) return 0;
    const TopLoc_Location between = relative_place(sources_.faces[face].face.Location(), place);
    const bool moves = !between.IsIdentity();
    const gp_Trsf move = between.Transformation();
    double most = 0;
    gp_Pnt on_curve;
    for (int k = 1; k <= polygon.NbNodes(); ++k) {
      curve->D0(polygon.Parameter(k), on_curve);
      gp_Pnt node = made_[face]->Node(polygon.Node(k));
      if (moves) node.Transform(move);
      most = std::max(most, on_curve.SquareDistance(node));
    }
    return std::sqrt(most);
  }

  bool has_polygon(std::uint32_t edge, std::uint32_t face, std::size_t known) const {
    const auto key = [](const EdgePolygon& of) { return std::pair(of.edge, of.face); };
    return std::ranges::binary_search(std::span(all_).first(known), std::pair(edge, face), {}, key);
  }
  /// The node at a vertex of the shape in a face: an end of another edge's polygon; 0 if there is none.
  int node_at(const Shape& shape, std::uint32_t vertex, std::uint32_t face, std::size_t known) const {
    if (vertex == no_id) return 0;
    for (const EdgePolygon& one : std::span(all_).first(known)) {
      if (one.face != face) continue;
      if (shape.edges[one.edge].start == vertex) return one.first->Node(1);
      if (shape.edges[one.edge].end == vertex) return one.first->Node(one.first->NbNodes());
    }
    return 0;
  }
  /// Adds the polygon of an edge without vertices of its own, if it is no longer than its tolerance.
  void add_point(const Shape& shape, std::uint32_t edge, std::uint32_t face, std::size_t known) {
    const int start = node_at(shape, shape.edges[edge].start, face, known),
              end = node_at(shape, shape.edges[edge].end, face, known);
    const double most = 2 * BRep_Tool::Tolerance(sources_.edges[edge].edge);
    const bool is_point = start > 0 && end > 0 && made_[face]->Node(start).Distance(made_[face]->Node(end)) <= most;
    if (!is_point) return lacking_.push_back(face);
    const Interval& range = shape.edges[edge].range;
    points_ = {{range.from, start}, {range.to, end}};
    all_.push_back({edge, face, polygon_of(edge, face), {}, {}});
  }

  /// Adds the other polygon of a seam: the first one becomes that of the forward edge.
  void add_second(EdgePolygon& seam, const handle<Poly_PolygonOnTriangulation>& polygon) const {
    seam.second = polygon;
    if (distance_of_forward(seam, polygon) < distance_of_forward(seam, seam.first)) std::swap(seam.first, seam.second);
  }
  /// Returns how far the middle of a polygon is from the curve that the forward edge has in the parameters of the face.
  double distance_of_forward(const EdgePolygon& seam, const handle<Poly_PolygonOnTriangulation>& polygon) const {
    const TopoDS_Edge edge = TopoDS::Edge(sources_.edges[seam.edge].edge.Oriented(TopAbs_FORWARD));
    const TopoDS_Face face = TopoDS::Face(sources_.faces[seam.face].face.Oriented(TopAbs_FORWARD));
    double from = 0, to = 0;
    const handle<Geom2d_Curve> curve = BRep_Tool::CurveOnSurface(edge, face, from, to);
    if (curve.IsNull()) return 0;
    const int middle = (polygon->NbNodes() + 1) / 2;
    return curve->Value(polygon->Parameter(middle)).Distance(made_[seam.face]->UVNode(polygon->Node(middle)));
  }

  const PatchSet& set_;
  const FaceTriangulations& nodes_;
  std::span<const handle<Poly_Triangulation>> made_;
  const OcctShape& sources_;
  std::vector<double> stations_;  ///< of all uses of the edge
  std::vector<Point> points_;     ///< of a use
  std::vector<Point> filled_;
  std::vector<EdgePolygon> all_;
  std::vector<std::uint32_t> lacking_;
};

}  // namespace

Result<EdgePolygons> edge_polygons(const PatchSet& set, const FaceTriangulations& nodes,
                                   std::span<const handle<Poly_Triangulation>> made, const Shape& shape,
                                   const OcctShape& sources, std::span<const EdgeVertex> on_edges,
                                   const Execution& execution) {
  std::vector<std::span<const EdgeVertex>> edges;
  for (std::size_t begin = 0, end = 0; begin < on_edges.size(); begin = end) {
    while (end < on_edges.size() && on_edges[end].edge == on_edges[begin].edge) ++end;
    edges.push_back(on_edges.subspan(begin, end - begin));
  }
  const std::size_t tasks = std::max<std::size_t>(1, (edges.size() + edges_per_maker - 1) / edges_per_maker);
  std::vector<PolygonMaker> makers(tasks, PolygonMaker(set, nodes, made, sources));
  const auto add_some = [&](std::size_t task) {
    makers[task].reserve();
    for (std::size_t k = task * edges_per_maker; k < std::min(edges.size(), (task + 1) * edges_per_maker); ++k)
      makers[task].add(edges[k]);
    return Status();
  };
  if (Status status = each_on_threads(tasks, 1, execution, add_some); !status.ok()) return status;
  for (std::size_t task = 1; task < tasks; ++task) makers[0].append(std::move(makers[task]));
  return std::move(makers[0]).finish(shape);
}

}}  // namespace tessera::abi_0_1
