#include "occt/plane_curve.h"

#include <opencascade/BRep_Tool.hxx>
#include <opencascade/Geom2d_BSplineCurve.hxx>
#include <opencascade/Geom2d_Circle.hxx>
#include <opencascade/Geom2d_Ellipse.hxx>
#include <opencascade/Geom2d_Line.hxx>
#include <opencascade/Geom_BSplineCurve.hxx>
#include <opencascade/Geom_Circle.hxx>
#include <opencascade/Geom_Ellipse.hxx>
#include <opencascade/Geom_Line.hxx>
#include <opencascade/Precision.hxx>

#include <cmath>

#include "occt/kind_of.h"
#include "occt/relative_place.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

using opencascade::handle;

/// Projects onto a plane along its normal.
class Projection {
 public:
  explicit Projection(const gp_Ax3& axes)
      : origin_(axes.Location().XYZ()),
        x_(axes.XDirection().XYZ()),
        y_(axes.YDirection().XYZ()),
        normal_(axes.Direction().XYZ()) {}

  gp_XY operator()(const gp_Pnt& point) const { return along(point.XYZ() - origin_); }
  gp_XY operator()(const gp_Dir& direction) const { return along(direction.XYZ()); }
  /// Whether the plane of the axes is parallel to this one, up to rounding of lengths.
  bool is_parallel(const gp_Ax2& axes) const {
    constexpr double most = 1e-9;
    return std::abs(axes.XDirection().XYZ() * normal_) <= most && std::abs(axes.YDirection().XYZ() * normal_) <= most;
  }
  gp_Ax22d operator()(const gp_Ax2& axes) const {
    return gp_Ax22d((*this)(axes.Location()), gp_Dir2d((*this)(axes.XDirection())),
                    gp_Dir2d((*this)(axes.YDirection())));
  }

 private:
  gp_XY along(const gp_XYZ& vector) const { return gp_XY(vector * x_, vector * y_); }

  gp_XYZ origin_, x_, y_, normal_;
};

/// Null for a line that is not parallel to the plane.
handle<Geom2d_Curve> projected(const gp_Ax1& line, const Projection& projection) {
  const gp_XY direction = projection(line.Direction());
  if (std::abs(direction.Modulus() - 1) >= ::Precision::Confusion()) return {};
  return new Geom2d_Line(projection(line.Location()), gp_Dir2d(direction));
}

handle<Geom2d_Curve> projected(const Geom_BSplineCurve& spline, const Projection& projection) {
  const TColgp_Array1OfPnt& poles = spline.Poles();
  TColgp_Array1OfPnt2d flat(poles.Lower(), poles.Upper());
  for (int k = poles.Lower(); k <= poles.Upper(); ++k) flat(k) = projection(poles(k));
  if (!spline.IsRational())
    return new Geom2d_BSplineCurve(flat, spline.Knots(), spline.Multiplicities(), spline.Degree(), spline.IsPeriodic());
  return new Geom2d_BSplineCurve(flat, *spline.Weights(), spline.Knots(), spline.Multiplicities(), spline.Degree(),
                                 spline.IsPeriodic());
}

}  // namespace

handle<Geom2d_Curve> curve_on_plane(const TopoDS_Edge& edge, const Geom_Plane& plane, const TopLoc_Location& place,
                                    Interval& range) {
  TopLoc_Location location;
  const handle<Geom_Curve>& curve = BRep_Tool::Curve(edge, location, range.from, range.to);
  if (curve.IsNull() || !relative_place(location, place).IsIdentity()) return {};
  const Projection projection(plane.Position());
  if (const auto* const line = kind_of<Geom_Line>(curve)) return projected(line->Position(), projection);
  if (const auto* const circle = kind_of<Geom_Circle>(curve)) {
    if (!projection.is_parallel(circle->Position())) return {};
    return new Geom2d_Circle(projection(circle->Position()), circle->Radius());
  }
  if (const auto* const ellipse = kind_of<Geom_Ellipse>(curve)) {
    if (!projection.is_parallel(ellipse->Position())) return {};
    return new Geom2d_Ellipse(projection(ellipse->Position()), ellipse->MajorRadius(), ellipse->MinorRadius());
  }
  const auto* const spline = kind_of<Geom_BSplineCurve>(curve);
  return spline ? projected(*spline, projection) : handle<Geom2d_Curve>();
}

}}  // namespace tessera::abi_0_1
