#include "occt/shape_edges.h"

#include <opencascade/BRep_Tool.hxx>
#include <opencascade/Geom_Curve.hxx>
#include <opencascade/Geom_Line.hxx>
#include <opencascade/TopExp.hxx>
#include <opencascade/TopoDS.hxx>
#include <opencascade/TopoDS_Vertex.hxx>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "exact/coedge_parameter.h"
#include "occt/guarded_calls.h"
#include "occt/kind_of.h"
#include "occt/occt_parameter.h"
#include "occt/spline_line.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

using opencascade::handle;

double length_or_zero(double value) { return std::isfinite(value) && value > 0 ? value : 0; }

bool is_range(const Interval& range) { return range.from < range.to && std::isfinite(range.to - range.from); }

/// A length along an edge as a share of its range, of 1e-10 to 1e-7.
double share_of(double length_along, const BrepEdge& edge) {
  constexpr double least = 1e-10, most = 1e-7;
  if (!edge.curve) return least;
  double all = 0;  // no less than the edge's length
  const auto points = edge.curve->points();
  for (std::size_t k = 0; k + 1 < points.size(); ++k) all += length(points[k + 1] - points[k]);
  return all > 0 ? std::clamp(length_along / all, least, most) : least;
}

/// Whether a range is longer than a closed curve, up to rounding: such an edge would take memory by the number of its
/// turns.
bool turns_twice(const Geom_Curve& curve, const Interval& range) {
  return curve.IsPeriodic() && range.to - range.from > (1 + 1e-9) * curve.Period();
}

/// The curve of an edge over its range. Most are lines, which take no detour over lists of points and knots.
Result<Curve> edge_curve(const handle<Geom_Curve>& curve, const Interval& range, std::optional<Arcs>& arcs) {
  if (const auto* const line = kind_of<Geom_Line>(curve)) {
    const std::array points{vec3(line->Value(range.from).XYZ()), vec3(line->Value(range.to).XYZ())};
    return Curve::b_spline(1, points, std::array{range.from, range.from, range.to, range.to});
  }
  const Result<SplineLine> line = spline_line(curve, range);
  if (!line) return line.status();
  arcs = line->arcs;
  return curve_of(*line);
}

}  // namespace

Result<ShapeEdges> ShapeEdges::make(const TopoDS_Shape& shape, const Execution& execution) {
  ShapeEdges out;
  for_shapes(shape, TopAbs_FACE, [&](const TopoDS_Shape& face) {
    for_shapes(face, TopAbs_EDGE, [&](const TopoDS_Shape& edge) { out.edge_numbers_.add(edge); });
  });
  const std::size_t count = out.edge_numbers_.size();
  out.vertex_numbers_.reserve(count);
  for (std::size_t k = 0; k < count; ++k)
    for_shapes(out.edge_numbers_[k], TopAbs_VERTEX,
               [&](const TopoDS_Shape& vertex) { out.vertex_numbers_.add(vertex); });
  out.vertices_.reserve(out.vertex_numbers_.size());
  for (std::size_t k = 0; k < out.vertex_numbers_.size(); ++k) {
    const TopoDS_Vertex& vertex = TopoDS::Vertex(out.vertex_numbers_[k]);
    out.vertices_.push_back({vec3(BRep_Tool::Pnt(vertex).XYZ()), length_or_zero(BRep_Tool::Tolerance(vertex))});
  }
  out.edges_.resize(count);
  out.parameters_.resize(count);
  const Status status = each_on_threads(count, 4, execution, [&](std::size_t k) {
    out.read_edge(k);
    return Status();
  });
  if (!status.ok()) return status;
  return out;
}

std::uint32_t ShapeEdges::vertex_id(const TopoDS_Shape& vertex) const {
  const std::uint32_t number = vertex.IsNull() ? no_id : vertex_numbers_.find(vertex);
  return number == no_id || !is_finite(vertices_[number].position) ? no_id : number;
}

void ShapeEdges::read_edge(std::size_t k) {
  const TopoDS_Edge edge = TopoDS::Edge(edge_numbers_[k].Oriented(TopAbs_FORWARD));
  BrepEdge& out = edges_[k];
  Parameter& parameter = parameters_[k];
  TopoDS_Vertex start, end;
  TopExp::Vertices(edge, start, end);
  out.start = vertex_id(start);
  out.end = vertex_id(end);
  out.tolerance = length_or_zero(BRep_Tool::Tolerance(edge));
  out.degenerate = BRep_Tool::Degenerated(edge);
  out.same_parameter = BRep_Tool::SameParameter(edge);
  double from = 0, to = 0;
  const handle<Geom_Curve> curve = BRep_Tool::Curve(edge, from, to);
  if (curve.IsNull()) BRep_Tool::Range(edge, from, to);
  if (!is_range({from, to})) return;
  if (!curve.IsNull() && turns_twice(*curve, {from, to})) return;
  out.range = parameter.theirs = {from, to};
  if (curve.IsNull() || out.degenerate) return;
  std::optional<Arcs> arcs;
  Result<Curve> made = edge_curve(curve, out.range, arcs);
  if (!made) return;
  out.range = made->domain();
  out.curve = *std::move(made);
  parameter.arcs = arcs;
}

Coedge ShapeEdges::coedge(const TopoDS_Edge& edge, const TrimCurve& trim, const Interval& theirs,
                          double tolerance) const {
  Coedge out{no_id, edge.Orientation() == TopAbs_REVERSED, {}};
  out.edge = edge_numbers_.find(edge);
  if (out.edge == no_id) return out;
  const Parameter& parameter = parameters_[out.edge];
  const Interval range = edges_[out.edge].range, whole = parameter.theirs;  // whole: ours if there is no range
  if (edges_[out.edge].degenerate || !is_range(theirs) || !is_range(whole)) return out;
  const bool is_even = parameter.arcs ? trim.parameter.follows(*parameter.arcs) : trim.parameter.is_plain();
  if (is_even && whole == theirs && range == theirs && trim.curve.domain() == theirs) return out;
  // From the edge's parameter to OpenCASCADE's, to that of the face's curve, to ours.
  const double stretch = (theirs.to - theirs.from) / (whole.to - whole.from);
  const auto their = [&](double s) {
    const double t = parameter.arcs ? parameter.arcs->angle(s) : s;
    return whole == theirs ? t : theirs.from + stretch * (t - whole.from);
  };
  MonotoneFunction f{range, [&](double s) { return trim.parameter(their(s)); }, {}};
  if (parameter.arcs) f.breaks = parameter.arcs->knots();
  for (const double b : trim.parameter.breaks()) {
    const double t = whole == theirs ? b : whole.from + (b - theirs.from) / stretch;
    f.breaks.push_back(parameter.arcs ? parameter.arcs->parameter(t) : t);
  }
  settle_breaks(f);
  state_parameter(f, trim.curve.domain(), out, share_of(tolerance, edges_[out.edge]));
  return out;
}

void ShapeEdges::give_to(Shape& shape, OcctShape& sources) && {
  sources.edges.reserve(edges_.size());
  for (std::size_t k = 0; k < edges_.size(); ++k)
    sources.edges.push_back(
        {TopoDS::Edge(edge_numbers_[k].Oriented(TopAbs_FORWARD)), occt_parameter(parameters_[k].arcs)});
  sources.vertices.reserve(vertices_.size());
  for (std::size_t k = 0; k < vertices_.size(); ++k) sources.vertices.push_back(TopoDS::Vertex(vertex_numbers_[k]));
  // An unusable vertex has no edges, see vertex_id().
  for (BrepVertex& vertex : vertices_)
    if (!is_finite(vertex.position)) vertex.position = {};
  shape.vertices = std::move(vertices_);
  shape.edges = std::move(edges_);
}

}}  // namespace tessera::abi_0_1
