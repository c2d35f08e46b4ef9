#include "occt/edge_polygons.h"

#include <opencascade/BRep_Tool.hxx>
#include <opencascade/Geom2d_Curve.hxx>
#include <opencascade/TopoDS.hxx>

#include <algorithm>
#include <cmath>
#include <utility>

namespace tessera { inline namespace abi_0_1 {
namespace {

using opencascade::handle;

class PolygonMaker {
 public:
  PolygonMaker(const PatchSet& set, const FaceTriangulations& nodes, std::span<const handle<Poly_Triangulation>> made,
               const OcctShape& sources)
      : set_(set), nodes_(nodes), made_(made), sources_(sources) {}

  /// Adds the polygons of an edge: all its vertices, by uses.
  void add(std::span<const EdgeVertex> of_edge) {
    stations_.clear();
    for (const EdgeVertex& one : of_edge) stations_.push_back(one.s);
    std::ranges::sort(stations_);
    stations_.erase(std::ranges::unique(stations_).begin(), stations_.end());
    for (std::size_t begin = 0, end = 0; begin < of_edge.size(); begin = end) {
      while (end < of_edge.size() && of_edge[end].use == of_edge[begin].use) ++end;
      add_use(of_edge.subspan(begin, end - begin));
    }
  }

  std::vector<EdgePolygon> finish() && { return std::move(all_); }

 private:
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
    const handle<Poly_PolygonOnTriangulation> polygon = polygon_of(sources_.edges[edge]);
    polygon->Deflection(made_[face]->Deflection());
    // Uses are in the order of faces, so those of a seam follow each other.
    if (!all_.empty() && all_.back().edge == edge && all_.back().face == face) {
      if (all_.back().second.IsNull()) add_second(all_.back(), polygon);
    } else {
      all_.push_back({edge, face, polygon, {}});
    }
  }

  /// Adds the stations that this use lacks but others have, at the nodes nearest to them, so that all uses have as many:
  /// a loop may leave the face just before the edge ends.
  void fill() {
    const double near = 1e-3 * (stations_.back() - stations_.front());
    std::vector<Point> all;
    std::size_t next = 0;  // the first own point that is not before the station
    for (const double s : stations_) {
      while (next < points_.size() && points_[next].s < s) ++next;
      const bool is_own = next < points_.size() && points_[next].s == s;
      const double above = next < points_.size() ? points_[next].s - s : HUGE_VAL;
      const double below = next > 0 ? s - points_[next - 1].s : HUGE_VAL;
      if (is_own || std::min(above, below) <= near) all.push_back({s, points_[above <= below ? next : next - 1].node});
    }
    if (all.size() == 1) all.push_back(all[0]);  // a short edge that is a point of the mesh
    points_ = std::move(all);
  }

  handle<Poly_PolygonOnTriangulation> polygon_of(const OcctEdge& edge) const {
    const auto count = static_cast<int>(points_.size());
    const handle<Poly_PolygonOnTriangulation> polygon = new Poly_PolygonOnTriangulation(count, true);
    for (int k = 0; k < count; ++k) {
      const Point& at = points_[static_cast<std::size_t>(k)];
      polygon->SetNode(k + 1, at.node);
      polygon->SetParameter(k + 1, edge.parameter.to_occt(at.s));
    }
    double from = 0, to = 0;
    BRep_Tool::Range(edge.edge, from, to);
    const double near = 1e-4 * (to - from);
    const bool is_point = points_[0].s == points_.back().s;
    if (is_point || polygon->Parameter(1) - from <= near) polygon->SetParameter(1, from);
    if (is_point || to - polygon->Parameter(count) <= near) polygon->SetParameter(count, to);
    return polygon;
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
  std::vector<EdgePolygon> all_;
};

}  // namespace

std::vector<EdgePolygon> edge_polygons(const PatchSet& set, const FaceTriangulations& nodes,
                                       std::span<const handle<Poly_Triangulation>> made, const OcctShape& sources,
                                       std::span<const EdgeVertex> on_edges) {
  PolygonMaker maker(set, nodes, made, sources);
  for (std::size_t begin = 0, end = 0; begin < on_edges.size(); begin = end) {
    while (end < on_edges.size() && on_edges[end].edge == on_edges[begin].edge) ++end;
    maker.add(on_edges.subspan(begin, end - begin));
  }
  return std::move(maker).finish();
}

}}  // namespace tessera::abi_0_1
