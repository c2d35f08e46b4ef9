#include "occt/face_surface.h"

#include <opencascade/GeomAdaptor_Surface.hxx>
#include <opencascade/GeomConvert_ApproxSurface.hxx>
#include <opencascade/Geom_BSplineSurface.hxx>
#include <opencascade/Geom_BezierSurface.hxx>
#include <opencascade/Geom_OffsetSurface.hxx>
#include <opencascade/Geom_RectangularTrimmedSurface.hxx>
#include <opencascade/Geom_SurfaceOfLinearExtrusion.hxx>
#include <opencascade/Geom_SurfaceOfRevolution.hxx>
#include <opencascade/gp_Cone.hxx>
#include <opencascade/gp_Cylinder.hxx>
#include <opencascade/gp_Pln.hxx>
#include <opencascade/gp_Sphere.hxx>
#include <opencascade/gp_Torus.hxx>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "exact/straight_lines.h"
#include "exact/thinned_spline.h"
#include "occt/guarded_calls.h"
#include "occt/kind_of.h"
#include "occt/spline_line.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

using opencascade::handle;

Frame frame_of(const gp_Ax3& axes) {
  return {vec3(axes.Location().XYZ()), vec3(axes.XDirection().XYZ()), vec3(axes.YDirection().XYZ()),
          vec3(axes.Direction().XYZ())};
}

Result<FaceSurface> from_revolution(const Geom_SurfaceOfRevolution& surface, const Domain& box) {
  Result<SplineLine> profile = spline_line(surface.BasisCurve(), range_v(box));
  if (!profile) return profile.status();
  const Frame frame = frame_of(gp_Ax3(surface.Axis().Location(), surface.Axis().Direction()));
  for (Vec3& p : profile->points) p = frame.local(p);
  return revolved(frame, range_u(box), *profile);
}

Result<FaceSurface> from_extrusion(const Geom_SurfaceOfLinearExtrusion& surface, const Domain& box) {
  const Result<SplineLine> profile = spline_line(surface.BasisCurve(), range_u(box));
  if (!profile) return profile.status();
  return extruded(*profile, vec3(surface.Direction().XYZ()), range_v(box));
}

Result<FaceSurface> from_spline(const Geom_BSplineSurface& surface, const Domain& box, const SplineShift& most) {
  const double period_u = surface.IsUPeriodic() ? surface.UPeriod() : 0,
               period_v = surface.IsVPeriodic() ? surface.VPeriod() : 0;
  const PoleLine u = unrolled({surface.UDegree(), surface.NbUPoles(), period_u}, surface.UKnotSequence(), range_u(box));
  const PoleLine v = unrolled({surface.VDegree(), surface.NbVPoles(), period_v}, surface.VKnotSequence(), range_v(box));
  const bool rational = surface.IsURational() || surface.IsVRational();
  std::vector<Vec3> points;
  std::vector<double> weights;
  points.reserve(u.poles.size() * v.poles.size());
  if (rational) weights.reserve(u.poles.size() * v.poles.size());
  for (const int i : u.poles)
    for (const int j : v.poles) {
      points.push_back(vec3(surface.Pole(i + 1, j + 1).XYZ()));
      if (rational) weights.push_back(surface.Weight(i + 1, j + 1));
    }
  StraightenedNet net{{u.degree, u.knots, covered(u.knots, u.degree, range_u(box))},
                      {v.degree, v.knots, covered(v.knots, v.degree, range_v(box))},
                      std::move(points),
                      std::move(weights)};
  shorten_straight_lines(net);
  std::optional<SplineShift> shift;
  if (most.distance > 0) shift = thin(net, most);
  const Domain domain{net.u.part.from, net.u.part.to, net.v.part.from, net.v.part.to};
  Result<FaceSurface> made =
      with_parameters(rational ? BSplineSurface::rational(net.u.degree, net.u.knots, net.v.degree, net.v.knots,
                                                          std::move(net.points), std::move(net.weights), domain)
                               : BSplineSurface::polynomial(net.u.degree, net.u.knots, net.v.degree, net.v.knots,
                                                            std::move(net.points), domain),
                      {});
  if (made && shift) made->shift = *shift;
  return made;
}

Result<FaceSurface> from_bezier(const Geom_BezierSurface& surface, const Domain& box) {
  const bool rational = surface.IsURational() || surface.IsVRational();
  const auto knots = [](int degree) {
    std::vector<double> all(static_cast<std::size_t>(degree) + 1, 0.0);
    all.resize(2 * all.size(), 1.0);
    return all;
  };
  std::vector<Vec3> points;
  std::vector<double> weights;
  for (int i = 1; i <= surface.NbUPoles(); ++i)
    for (int j = 1; j <= surface.NbVPoles(); ++j) {
      points.push_back(vec3(surface.Pole(i, j).XYZ()));
      weights.push_back(rational ? surface.Weight(i, j) : 1);
    }
  const Domain domain{std::max(0.0, box.u0), std::min(1.0, box.u1), std::max(0.0, box.v0), std::min(1.0, box.v1)};
  return with_parameters(BSplineSurface::rational(surface.UDegree(), knots(surface.UDegree()), surface.VDegree(),
                                                  knots(surface.VDegree()), points, weights, domain),
                         {});
}

/// The largest distance of the two surfaces at equal parameters, on a fine grid.
double deviation(const Geom_Surface& a, const Geom_Surface& b, const Domain& box) {
  constexpr int steps = 48;
  double largest = 0;
  for (int i = 0; i <= steps; ++i)
    for (int j = 0; j <= steps; ++j) {
      const double u = box.u_at(static_cast<double>(i) / steps), v = box.v_at(static_cast<double>(j) / steps);
      largest = std::max(largest, a.Value(u, v).Distance(b.Value(u, v)));
    }
  return largest;
}

/// Approximates any surface, at equal parameters, to within 1e-6 of its size if OpenCASCADE can. Asks for C0 only: for
/// smoother fits OpenCASCADE 7.6 states errors that are too small by factors of thousands.
Result<FaceSurface> fitted(const handle<Geom_Surface>& surface, const Domain& box) {
  Box3 points;
  for (int k = 0; k < 25; ++k) points.extend(vec3(surface->Value(box.u_at(k % 5 / 4.0), box.v_at(k / 5 / 4.0)).XYZ()));
  const std::lock_guard lock(approximation_mutex());
  const handle<Geom_Surface> part = new Geom_RectangularTrimmedSurface(surface, box.u0, box.u1, box.v0, box.v1);
  const GeomConvert_ApproxSurface fit(part, 1e-6 * points.diagonal(), GeomAbs_C0, GeomAbs_C0, 9, 9, 100, 1);
  if (!fit.HasResult())
    return Status(StatusCode::unsupported,
                  std::string("a ") + surface->DynamicType()->Name() + " that OpenCASCADE cannot fit");
  Result<FaceSurface> face = from_spline(*fit.Surface(), box, {});
  if (face) face->fit_error = std::max(fit.MaxError(), deviation(*surface, *fit.Surface(), box));
  return face;
}

}  // namespace

handle<Geom_Surface> bare_surface(handle<Geom_Surface> surface) {
  for (;;) {
    handle<Geom_Surface> inner;
    if (const auto* const trimmed = kind_of<Geom_RectangularTrimmedSurface>(surface)) inner = trimmed->BasisSurface();
    if (const auto* const offset = kind_of<Geom_OffsetSurface>(surface)) inner = offset->Surface();
    if (inner.IsNull()) return surface;
    surface = inner;
  }
}

Result<FaceSurface> face_surface(const handle<Geom_Surface>& given, const Domain& box, const SplineShift& most) {
  const handle<Geom_Surface> surface = bare_surface(given);
  if (const auto* const s = kind_of<Geom_BSplineSurface>(surface)) return from_spline(*s, box, most);
  if (const auto* const s = kind_of<Geom_BezierSurface>(surface)) return from_bezier(*s, box);
  if (const auto* const s = kind_of<Geom_SurfaceOfRevolution>(surface)) return from_revolution(*s, box);
  if (const auto* const s = kind_of<Geom_SurfaceOfLinearExtrusion>(surface)) return from_extrusion(*s, box);
  const GeomAdaptor_Surface adaptor(surface);
  switch (adaptor.GetType()) {
    case GeomAbs_Plane:
      return plane_surface(frame_of(adaptor.Plane().Position()), box);
    case GeomAbs_Cylinder:
      return cylinder_surface(frame_of(adaptor.Cylinder().Position()), adaptor.Cylinder().Radius(), box);
    case GeomAbs_Cone:
      return cone_surface(frame_of(adaptor.Cone().Position()), adaptor.Cone().RefRadius(), adaptor.Cone().SemiAngle(),
                          box);
    case GeomAbs_Sphere:
      return torus_surface(frame_of(adaptor.Sphere().Position()), 0, adaptor.Sphere().Radius(), box);
    case GeomAbs_Torus:
      return torus_surface(frame_of(adaptor.Torus().Position()), adaptor.Torus().MajorRadius(),
                           adaptor.Torus().MinorRadius(), box);
    default:
      return fitted(surface, box);
  }
}

}}  // namespace tessera::abi_0_1
