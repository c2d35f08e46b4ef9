#include "occt/face_loops.h"

#include <opencascade/BRep_Tool.hxx>
#include <opencascade/GeomAdaptor_Surface.hxx>
#include <opencascade/Geom_BSplineCurve.hxx>
#include <opencascade/Geom_BSplineSurface.hxx>
#include <opencascade/Precision.hxx>

#include <algorithm>
#include <cmath>

#include "occt/trim_curve.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

using opencascade::handle;

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

/// The sides of a surface that curves leave by less than the tolerances of their face.
class SurfaceSides {
 public:
  SurfaceSides(const FaceBorder& border, const FaceBox& box) : box_(box), tolerance_(border.vertex_tolerance) {
    TopLoc_Location location;
    surface_ = BRep_Tool::Surface(border.face, location);
  }

  /// Moves the parts of a curve that leave the surface by less than the tolerance onto the side there: the trim would
  /// cut them off, and what is cut off meets no other face along the edge.
  Status keep_inside(Curve& curve) const {
    const auto moves = [&](Vec3 point) { return keep_inside(point); };
    if (std::ranges::none_of(curve.points(), moves)) return {};
    std::vector<Vec3> points(curve.points().begin(), curve.points().end());
    for (Vec3& p : points) keep_inside(p);
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

/// How far the curves of loops may lie from those of the file.
struct LoopTolerances {
  ParameterPoint curve;  ///< in our parameters of the surface
  double along = 0;      ///< of an edge's parameter along it, as a length; 0: as far as rounding allows
};

Status append_edge(const BorderEdge& border, const SurfaceSides& sides, const Reparametrization& parameters,
                   const LoopTolerances& tolerances, const ShapeEdges& edges, TrimLoop& loop) {
  if (border.curve.IsNull()) return Status(StatusCode::unsupported, "an edge has no curve in the face's parameters");
  const bool reversed = border.edge.Orientation() == TopAbs_REVERSED;
  Result<TrimCurve> made = trim_curve(border.curve, border.range, reversed, parameters, tolerances.curve);
  if (!made) return made.status();
  if (Status status = sides.keep_inside(made->curve); !status.ok()) return status;
  loop.coedges.push_back(edges.coedge(border.edge, *made, border.range, tolerances.along));
  loop.curves.push_back(std::move(made->curve));
  return {};
}

/// How far a fitted curve may lie from its own, in our parameters: along arcs, these grow at 0.94 to 1.12 times the
/// rate of OpenCASCADE's.
ParameterPoint fit_tolerance(const FaceBorder& border, const FaceBox& box, const Reparametrization& parameters) {
  const Domain& d = box.domain;
  const double least = 1e-9 * std::min(d.u1 - d.u0, d.v1 - d.v0);
  if (border.fit_tolerance == 0 || parameters.is_identity()) return {least, least};
  TopLoc_Location location;
  const GeomAdaptor_Surface adaptor(bare_surface(BRep_Tool::Surface(border.face, location)), d.u0, d.u1, d.v0, d.v1);
  // OpenCASCADE's resolutions of surfaces of revolution, say, do not depend on the radius.
  const bool has_resolution = adaptor.GetType() <= GeomAbs_BSplineSurface;
  if (!has_resolution) return {least, least};
  constexpr double slope = 0.94, most = 1e-3;  // most: a share of the range
  const auto within = [&](double resolution, double range) {
    return std::clamp(slope * resolution, least, std::max(least, most * range));
  };
  return {within(adaptor.UResolution(border.fit_tolerance), d.u1 - d.u0),
          within(adaptor.VResolution(border.fit_tolerance), d.v1 - d.v0)};
}

}  // namespace

Result<FaceBox> face_box(const FaceBorder& border) {
  TopLoc_Location location;
  const handle<Geom_Surface> given = BRep_Tool::Surface(border.face, location);
  // Edges may leave the rectangle that trims a surface, and run over the seam of the surface inside.
  const handle<Geom_Surface> surface = bare_surface(given);
  const GeomAdaptor_Surface adaptor(surface);
  const double tolerance = border.tolerance;
  FreeRange u{}, v{};
  if (border.box.IsVoid())
    given->Bounds(u.from, u.to, v.from, v.to);
  else
    border.box.Get(u.from, v.from, u.to, v.to);
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

Result<FaceLoops> face_loops(const FaceBorder& border, const FaceBox& box, const Reparametrization& parameters,
                             const ShapeEdges& edges) {
  const SurfaceSides sides(border, box);
  const LoopTolerances tolerances{fit_tolerance(border, box, parameters), border.fit_tolerance};
  FaceLoops out;
  for (const BorderWire& wire : border.wires) {
    TrimLoop loop{{}, !wire.is_outer};
    loop.curves.reserve(wire.edges.size());
    loop.coedges.reserve(wire.edges.size());
    for (const BorderEdge& edge : wire.edges)
      if (Status status = append_edge(edge, sides, parameters, tolerances, edges, loop); !status.ok()) return status;
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
