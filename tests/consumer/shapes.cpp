// A program of OpenCASCADE that makes a model of a shape in memory. Returns 0 if its mesh is that of the shape.

#include <tessera/occt.h>
#include <tessera/tessera.h>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Geom_SphericalSurface.hxx>
#include <TopoDS_Face.hxx>

#include <cmath>
#include <cstdio>

int main() {
  TopoDS_Face sphere;
  BRep_Builder().MakeFace(sphere, new Geom_SphericalSurface(gp_Ax3(gp_Pnt(1, 2, 3), gp_Dir(0, 0, 1)), 2), 1e-7);
  const tessera::Result<tessera::OcctModel> made = tessera::model_from(sphere);
  if (!made) {
    std::puts(made.status().message().c_str());
    return 1;
  }
  const tessera::Result<tessera::AreaMeasures> measures = tessera::measure_surfaces(made->model);
  const double area = measures ? measures->total.area.value : 0;
  const tessera::OcctPoint at = made->at(0, 0.7, 0.3);
  const gp_Pnt point = BRep_Tool::Surface(at.face)->Value(at.u, at.v);
  const bool on_sphere = std::abs(point.Distance(gp_Pnt(1, 2, 3)) - 2) < 1e-12;
  const bool refused = tessera::model_from(TopoDS_Shape()).status().code() == tessera::StatusCode::invalid_argument;
  std::printf("area %.6f\n", area);
  return std::abs(area - 16 * 3.14159265358979) < 1e-6 && at.face.IsSame(sphere) && on_sphere && refused ? 0 : 1;
}
