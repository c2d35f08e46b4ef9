#include "occt/face_loops.h"

#include <opencascade/BRepTools.hxx>
#include <opencascade/BRepTools_WireExplorer.hxx>
#include <opencascade/BRep_Tool.hxx>
#include <opencascade/BndLib_Add2dCurve.hxx>
#include <opencascade/Bnd_Box2d.hxx>
#include <opencascade/Geom2dConvert.hxx>
#include <opencascade/Geom2d_BSplineCurve.hxx>
#include <opencascade/Geom2d_TrimmedCurve.hxx>
#include <opencascade/GeomAdaptor_Surface.hxx>
#include <opencascade/Geom_BSplineCurve.hxx>
#include <opencascade/Geom_BSplineSurface.hxx>
#include <opencascade/Precision.hxx>
#include <opencascade/TopExp_Explorer.hxx>
#include <opencascade/TopoDS.hxx>
#include <opencascade/TopoDS_Iterator.hxx>
#include <opencascade/TopoDS_Vertex.hxx>
#include <opencascade/TopoDS_Wire.hxx>

#include <algorithm>
#include <cmath>

#include "occt/trim_curve.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

using opencascade::handle;

/// The largest tolerance that the face and its edges state, at least OpenCASCADE's own: shorter lengths are rounding to
/// its users.
double tolerance_of(const TopoDS_Face& face) {
  double tolerance = std::max(::Precision::Confusion(), BRep_Tool::Tolerance(face));
  for (TopExp_Explorer edge(face, TopAbs_EDGE); edge.More(); edge.Next())
    tolerance = std::max(tolerance, BRep_Tool::Tolerance(TopoDS::Edge(edge.Current())));
  return tolerance;
}

std::vector<double> values(const TColStd_Array1OfReal& array) { return {array.begin(), array.end()}; }

std::vector<double> knots_of(const Adaptor3d_Curve& curve) {
  return curve.GetType() == GeomAbs_BSplineCurve ? values(curve.BSpline()->Knots()) : std::vector<double>();
}

std::vector<double> knots_u(const GeomAdaptor_Surface& surface) {
  if (surface.GetType() == GeomAbs_BSplineSurface) return values(surface.BSpline()->UKnots());
  if (surface.GetType() == GeomAbs_SurfaceOfExtrusion) return knots_of(*surface.BasisCurve());
  return {};
}

std::vector<double> knots_v(const GeomAdaptor_Surface& surface) {
  if (surface.GetType() == GeomAbs_BSplineSurface) return values(surface.BSpline()->VKnots());
  if (surface.GetType() == GeomAbs_SurfaceOfRevolution) return knots_of(*surface.BasisCurve());
  return {};
}

/// Whether the edge bounds its face: INTERNAL and EXTERNAL edges lie in a face, or beside it, without cutting it.
bool is_border(const TopoDS_Shape& edge) {
  return edge.Orientation() == TopAbs_FORWARD || edge.Orientation() == TopAbs_REVERSED;
}

/// The edges of a wire that bound the face, in their order. If the wire is broken, the edges that the walk along it
/// does not reach come last.
std::vector<TopoDS_Edge> edges_of(const TopoDS_Wire& wire, const TopoDS_Face& face) {
  std::vector<TopoDS_Edge> edges;
  for (BRepTools_WireExplorer walk(wire, face); walk.More(); walk.Next())
    if (is_border(walk.Current())) edges.push_back(walk.Current());
  std::vector<TopoDS_Edge> all;
  for (TopoDS_Iterator child(wire); child.More(); child.Next())
    if (child.Value().ShapeType() == TopAbs_EDGE && is_border(child.Value()))
      all.push_back(TopoDS::Edge(child.Value()));
  if (all.size() == edges.size()) return edges;
  for (const TopoDS_Edge& edge : all) {
    const auto same = [&](const TopoDS_Edge& other) { return edge.IsEqual(other); };
    if (std::none_of(edges.begin(), edges.end(), same)) edges.push_back(edge);
  }
  return edges;
}

/// The sides of a surface that curves leave by less than the tolerances of their face.
class SurfaceSides {
 public:
  SurfaceSides(const TopoDS_Face& face, const FaceBox& box) : box_(box), tolerance_(tolerance_of(face)) {
    TopLoc_Location location;
    surface_ = BRep_Tool::Surface(face, location);
    for (TopExp_Explorer vertex(face, TopAbs_VERTEX); vertex.More(); vertex.Next())
      tolerance_ = std::max(tolerance_, BRep_Tool::Tolerance(TopoDS::Vertex(vertex.Current())));
  }

  /// Moves the parts of a curve that leave the surface by less than the tolerance onto the side there: the trim would
  /// cut them off, and what is cut off meets no other face along the edge.
  Status keep_inside(Curve& curve) const {
    std::vector<Vec3> points(curve.points().begin(), curve.points().end());
    bool moved = false;
    for (Vec3& p : points) moved = keep_inside(p) || moved;
    if (!moved) return {};
    Result<Curve> made = curve.is_rational()
                             ? Curve::nurbs(curve.degree(), points, curve.weights(), curve.knots(), curve.domain())
                             : Curve::b_spline(curve.degree(), points, curve.knots(), curve.domain());
    if (!made) return made.status();
    curve = *std::move(made);
    return {};
  }

 private:
  bool keep_inside(Vec3& point) const {
    const Domain& d = box_.domain;
    const Vec3 inside{box_.ends_u ? std::clamp(point.x, d.u0, d.u1) : point.x,
                      box_.ends_v ? std::clamp(point.y, d.v0, d.v1) : point.y, 0};
    if (inside.x == point.x && inside.y == point.y) return false;
    gp_Pnt at;
    gp_Vec along_u, along_v;
    surface_->D1(inside.x, inside.y, at, along_u, along_v);
    const double way =
        std::abs(inside.x - point.x) * along_u.Magnitude() + std::abs(inside.y - point.y) * along_v.Magnitude();
    if (!(way <= tolerance_)) return false;
    point = inside;
    return true;
  }

  const FaceBox& box_;
  double tolerance_;
  handle<Geom_Surface> surface_;
};

Status append_edge(const TopoDS_Edge& edge, const TopoDS_Face& face, const FaceBox& box, const SurfaceSides& sides,
                   const Reparametrization& parameters, const ShapeEdges& edges, TrimLoop& loop) {
  double from = 0, to = 0;
  const handle<Geom2d_Curve> curve = BRep_Tool::CurveOnSurface(edge, face, from, to);
  if (curve.IsNull()) return Status(StatusCode::unsupported, "an edge has no curve in the face's parameters");
  const Domain& d = box.domain;
  const double tolerance = 1e-9 * std::min(d.u1 - d.u0, d.v1 - d.v0);
  Result<TrimCurve> made = trim_curve(curve, {from, to}, edge.Orientation() == TopAbs_REVERSED, parameters, tolerance);
  if (!made) return made.status();
  if (Status status = sides.keep_inside(made->curve); !status.ok()) return status;
  loop.coedges.push_back(edges.coedge(edge, *made, {from, to}));
  loop.curves.push_back(std::move(made->curve));
  return {};
}

/// Adds the rectangle that holds an edge's curve. OpenCASCADE's own misses what a periodic spline has behind its seam.
void add_bounds(const TopoDS_Edge& edge, const TopoDS_Face& face, Bnd_Box2d& box) {
  double from = 0, to = 0;
  const handle<Geom2d_Curve> curve = BRep_Tool::CurveOnSurface(edge, face, from, to);
  if (curve.IsNull()) return;
  const handle<Geom2d_Curve> whole = bare_curve(curve);
  if (!whole->IsPeriodic() || !whole->IsKind(STANDARD_TYPE(Geom2d_BSplineCurve)) || !(from < to))
    return BRepTools::AddUVBounds(face, edge, box);
  const handle<Geom2d_BSplineCurve> part = Geom2dConvert::CurveToBSplineCurve(new Geom2d_TrimmedCurve(whole, from, to));
  if (part->IsPeriodic()) part->SetNotPeriodic();
  BndLib_Add2dCurve::Add(part, 0, box);
}

/// Sets the ends of the rectangle that holds the face's border; without any, of the surface's own.
void set_bounds_of_edges(const TopoDS_Face& given, const Geom_Surface& surface, FreeRange& u, FreeRange& v) {
  const TopoDS_Face face = TopoDS::Face(given.Oriented(TopAbs_FORWARD));
  Bnd_Box2d box;
  for (TopExp_Explorer edge(face, TopAbs_EDGE); edge.More(); edge.Next())
    if (is_border(edge.Current())) add_bounds(TopoDS::Edge(edge.Current()), face, box);
  if (box.IsVoid())
    surface.Bounds(u.from, u.to, v.from, v.to);
  else
    box.Get(u.from, v.from, u.to, v.to);
}

}  // namespace

Result<FaceBox> face_box(const TopoDS_Face& face) {
  TopLoc_Location location;
  const handle<Geom_Surface> given = BRep_Tool::Surface(face, location);
  // Edges may leave the rectangle that trims a surface, and run over the seam of the surface inside.
  const handle<Geom_Surface> surface = bare_surface(given);
  const GeomAdaptor_Surface adaptor(surface);
  const double tolerance = tolerance_of(face);
  FreeRange u{}, v{};
  set_bounds_of_edges(face, *given, u, v);
  surface->Bounds(u.first, u.last, v.first, v.last);
  if (surface->IsUPeriodic()) u.period = surface->UPeriod();
  if (surface->IsVPeriodic()) v.period = surface->VPeriod();
  u.length_tolerance = adaptor.UResolution(tolerance);
  v.length_tolerance = adaptor.VResolution(tolerance);
  u.knots = knots_u(adaptor);
  v.knots = knots_v(adaptor);
  for (FreeRange* const side : {&u, &v}) {
    const bool bounded = std::isfinite(side->to - side->from) && !::Precision::IsInfinite(side->from) &&
                         !::Precision::IsInfinite(side->to);
    if (!bounded) return Status(StatusCode::unsupported, "it has no bounds");
    if (!(side->from < side->to)) return Status(StatusCode::unsupported, "it has no extent");
    side->settle();
    if (!(side->from < side->to)) return Status(StatusCode::unsupported, "it has no extent");
  }
  return FaceBox{
      {u.from, u.to, v.from, v.to}, u.tolerance(), v.tolerance(), u.ends_with_surface(), v.ends_with_surface()};
}

Result<FaceLoops> face_loops(const TopoDS_Face& given, const FaceBox& box, const Reparametrization& parameters,
                             const ShapeEdges& edges) {
  // Wires of a reversed face run the other way; the region that a loop encloses does not depend on that.
  const TopoDS_Face face = TopoDS::Face(given.Oriented(TopAbs_FORWARD));
  const TopoDS_Wire outer = BRepTools::OuterWire(face);
  const SurfaceSides sides(face, box);
  FaceLoops out;
  for (TopoDS_Iterator child(face); child.More(); child.Next()) {
    if (child.Value().ShapeType() != TopAbs_WIRE) continue;
    const TopoDS_Wire wire = TopoDS::Wire(child.Value());
    TrimLoop loop{{}, !outer.IsNull() && !wire.IsSame(outer)};
    for (const TopoDS_Edge& edge : edges_of(wire, face))
      if (Status status = append_edge(edge, face, box, sides, parameters, edges, loop); !status.ok()) return status;
    const auto is_nameless = [](const Coedge& coedge) { return coedge.edge == no_id; };
    if (std::any_of(loop.coedges.begin(), loop.coedges.end(), is_nameless)) {
      loop.coedges.clear();
      out.unshared = true;
    }
    if (!loop.curves.empty()) out.loops.push_back(std::move(loop));
  }
  out.whole = is_whole_box(out.loops, box);
  return out;
}

}}  // namespace tessera::abi_0_1
