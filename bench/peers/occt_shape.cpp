#include "peers/occt_shape.h"

#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepTools.hxx>
#include <BRep_Tool.hxx>
#include <Message_ProgressIndicator.hxx>
#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TColStd_Array2OfReal.hxx>
#include <TColgp_Array2OfPnt.hxx>
#include <TopoDS_Compound.hxx>
#include <stdexcept>

#include "peers/interleaved.h"
#include "support/synthetic_sets.h"
#include "tessera/convert.h"

namespace tessera::bench {
namespace {

/// Control points of a surface with point(i, j), weight(i, j).
template <class Surface, class Index>
struct Poles {
  Poles(const Surface& surface, int rows, int columns) : points(1, rows, 1, columns), weights(1, rows, 1, columns) {
    for (int i = 0; i < rows; ++i)
      for (int j = 0; j < columns; ++j) {
        const Vec3& p = surface.point(Index(i), Index(j));
        points.SetValue(i + 1, j + 1, gp_Pnt(p.x, p.y, p.z));
        weights.SetValue(i + 1, j + 1, surface.weight(Index(i), Index(j)));
      }
  }
  TColgp_Array2OfPnt points;
  TColStd_Array2OfReal weights;
};

/// Distinct knots, and their multiplicities.
struct Knots {
  explicit Knots(std::span<const double> all) {
    for (const double knot : all) {
      if (values.empty() || knot > values.back()) values.push_back(knot), counts.push_back(0);
      ++counts.back();
    }
  }
  TColStd_Array1OfReal knots() const { return {values.front(), 1, static_cast<int>(values.size())}; }
  TColStd_Array1OfInteger multiplicities() const { return {counts.front(), 1, static_cast<int>(counts.size())}; }
  std::vector<double> values;
  std::vector<int> counts;
};

/// Ends work that takes too long.
class TimeLimit final : public Message_ProgressIndicator {
 public:
  explicit TimeLimit(double max_seconds) : end_(processor_seconds() + max_seconds) {}
  Standard_Boolean UserBreak() override { return stopped_ = stopped_ || processor_seconds() > end_; }
  bool stopped() const { return stopped_; }

 private:
  void Show(const Message_ProgressScope&, Standard_Boolean) override {}
  double end_;
  bool stopped_ = false;
};

}  // namespace

Handle(Geom_BSplineSurface) occt_surface(const BSplineSurface& surface) {
  const BSplineSurface own = test::value_of(clamp_ends(surface));
  const Poles<BSplineSurface, std::size_t> poles(own, static_cast<int>(own.count_u()), static_cast<int>(own.count_v()));
  const Knots u(own.knots_u()), v(own.knots_v());
  if (!own.is_rational())
    return new Geom_BSplineSurface(poles.points, u.knots(), v.knots(), u.multiplicities(), v.multiplicities(),
                                   own.degree_u(), own.degree_v());
  return new Geom_BSplineSurface(poles.points, poles.weights, u.knots(), v.knots(), u.multiplicities(),
                                 v.multiplicities(), own.degree_u(), own.degree_v());
}

Handle(Geom_BezierSurface) occt_surface(const BezierPatch& patch) {
  const Poles<BezierPatch, int> poles(patch, patch.degree_u() + 1, patch.degree_v() + 1);
  return patch.is_rational() ? new Geom_BezierSurface(poles.points, poles.weights)
                             : new Geom_BezierSurface(poles.points);
}

OcctShape::OcctShape(const std::vector<Handle(Geom_Surface)>& surfaces) {
  BRep_Builder builder;
  TopoDS_Compound all;
  builder.MakeCompound(all);
  for (const Handle(Geom_Surface) & surface : surfaces) {
    BRepBuilderAPI_MakeFace face(surface, 1e-7);
    if (!face.IsDone())
      throw std::runtime_error("OpenCASCADE makes no face of surface " + std::to_string(faces_.size()));
    faces_.push_back(face.Face());
    surfaces_.emplace_back(surface);
    builder.Add(all, faces_.back());
  }
  shape_ = all;
}

OcctShape::OcctShape(const TopoDS_Shape& shape, std::vector<TopoDS_Face> faces)
    : faces_(std::move(faces)), shape_(shape) {}

double OcctShape::mesh(double deflection, double angle, double max_seconds) {
  BRepTools::Clean(shape_);
  IMeshTools_Parameters parameters;
  parameters.Deflection = deflection;
  parameters.Angle = angle;
  BRepMesh_IncrementalMesh mesher;
  mesher.SetShape(shape_);
  mesher.ChangeParameters() = parameters;
  const Handle(TimeLimit) limit = new TimeLimit(max_seconds);
  const double seconds = seconds_of([&] { mesher.Perform(limit->Start()); });
  return limit->stopped() ? std::numeric_limits<double>::infinity() : seconds;
}

std::vector<SurfaceTriangle> OcctShape::triangles() const {
  std::vector<SurfaceTriangle> all;
  for (std::size_t face = 0; face < faces_.size(); ++face) {
    TopLoc_Location location;
    const Handle(Poly_Triangulation) triangles = BRep_Tool::Triangulation(faces_[face], location);
    if (triangles.IsNull()) continue;
    for (int k = 1; k <= triangles->NbTriangles(); ++k) {
      int corner[3];
      triangles->Triangle(k).Get(corner[0], corner[1], corner[2]);
      SurfaceTriangle t{face, {}, {}};
      for (std::size_t c = 0; c < 3; ++c) {
        const gp_Pnt2d uv = triangles->UVNode(corner[c]);
        const gp_Pnt p = triangles->Node(corner[c]).Transformed(location.Transformation());
        t.parameters[c] = {uv.X(), uv.Y()};
        t.corners[c] = {p.X(), p.Y(), p.Z()};
      }
      all.push_back(t);
    }
  }
  return all;
}

Vec3 OcctShape::point(std::size_t face, double u, double v) const {
  const gp_Pnt p = surfaces_[face].Value(u, v);
  return {p.X(), p.Y(), p.Z()};
}

}  // namespace tessera::bench
