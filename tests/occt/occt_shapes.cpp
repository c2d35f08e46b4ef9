#include "occt/occt_shapes.h"

#include <opencascade/BRepAlgoAPI_Cut.hxx>
#include <opencascade/BRepBuilderAPI_MakeEdge.hxx>
#include <opencascade/BRepBuilderAPI_MakeFace.hxx>
#include <opencascade/BRepBuilderAPI_Transform.hxx>
#include <opencascade/BRepFilletAPI_MakeFillet.hxx>
#include <opencascade/BRepPrimAPI_MakeBox.hxx>
#include <opencascade/BRepPrimAPI_MakeCone.hxx>
#include <opencascade/BRepPrimAPI_MakeCylinder.hxx>
#include <opencascade/BRepPrimAPI_MakePrism.hxx>
#include <opencascade/BRepPrimAPI_MakeRevol.hxx>
#include <opencascade/BRepPrimAPI_MakeSphere.hxx>
#include <opencascade/BRepPrimAPI_MakeTorus.hxx>
#include <opencascade/BRep_Builder.hxx>
#include <opencascade/GeomConvert.hxx>
#include <opencascade/Geom_BSplineSurface.hxx>
#include <opencascade/Geom_BezierCurve.hxx>
#include <opencascade/Geom_BezierSurface.hxx>
#include <opencascade/Geom_Ellipse.hxx>
#include <opencascade/Geom_OffsetSurface.hxx>
#include <opencascade/Geom_RectangularTrimmedSurface.hxx>
#include <opencascade/Geom_ToroidalSurface.hxx>
#include <opencascade/Standard_Version.hxx>
#include <opencascade/TopExp_Explorer.hxx>
#include <opencascade/TopoDS.hxx>
#include <opencascade/gp_Ax2.hxx>

#include <numbers>

namespace tessera::test {
namespace {

using opencascade::handle;

handle<Geom_Curve> profile() {
  TColgp_Array1OfPnt poles(1, 4);
  poles(1) = gp_Pnt(2, 0, 0), poles(2) = gp_Pnt(3, 0, 1), poles(3) = gp_Pnt(1, 0, 2), poles(4) = gp_Pnt(2.5, 0, 3);
  return new Geom_BezierCurve(poles);
}

handle<Geom_BezierSurface> wave() {
  TColgp_Array2OfPnt poles(1, 4, 1, 3);
  for (int i = 1; i <= 4; ++i)
    for (int j = 1; j <= 3; ++j) poles(i, j) = gp_Pnt(i + 0.1 * j, j - 0.2 * i, 0.5 * (i % 2) + 0.3 * (j % 2));
  return new Geom_BezierSurface(poles);
}

TopoDS_Face face_on(const handle<Geom_Surface>& surface) { return BRepBuilderAPI_MakeFace(surface, 1e-7).Face(); }

/// A torus as a periodic spline surface, and a part of it that crosses both seams.
TopoDS_Face over_seams() {
  const handle<Geom_Surface> torus = new Geom_ToroidalSurface(gp_Ax3(), 5, 2);
  const handle<Geom_BSplineSurface> spline = GeomConvert::SurfaceToBSplineSurface(torus);
  return BRepBuilderAPI_MakeFace(spline, 5.5, 7.5, 5, 8, 1e-7).Face();
}

TopoDS_Shape cut_cylinder() {
  const TopoDS_Shape across = BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(-5, 0.3, 2), gp_Dir(1, 0, 0.2)), 0.8, 10).Shape();
  return BRepAlgoAPI_Cut(BRepPrimAPI_MakeCylinder(2, 4).Shape(), across).Shape();
}

std::vector<NamedShape> plain_shapes() {
  const gp_Ax2 tilted(gp_Pnt(1, 2, 3), gp_Dir(1, 1, 1));
  const TopoDS_Shape edge = BRepBuilderAPI_MakeEdge(profile()).Edge();
  const TopoDS_Shape ellipse = BRepBuilderAPI_MakeEdge(new Geom_Ellipse(tilted, 3, 1), 0.3, 4).Edge();
  const handle<Geom_Surface> offset = new Geom_OffsetSurface(wave(), 0.2);
  return {{"box", BRepPrimAPI_MakeBox(1, 2, 3).Shape()},
          {"cylinder", BRepPrimAPI_MakeCylinder(tilted, 2, 5).Shape()},
          {"part of a cylinder", BRepPrimAPI_MakeCylinder(tilted, 2, 5, 2.5).Shape()},
          {"cone", BRepPrimAPI_MakeCone(tilted, 3, 1, 4).Shape()},
          {"cone with an apex", BRepPrimAPI_MakeCone(tilted, 3, 0, 4).Shape()},
          {"sphere", BRepPrimAPI_MakeSphere(tilted, 2).Shape()},
          {"part of a sphere", BRepPrimAPI_MakeSphere(tilted, 2, -0.5, 1.1, 2).Shape()},
          {"torus", BRepPrimAPI_MakeTorus(tilted, 5, 1).Shape()},
          {"part of a torus", BRepPrimAPI_MakeTorus(tilted, 5, 1, 0.5, 2.5, 4).Shape()},
          {"revolved spline", BRepPrimAPI_MakeRevol(edge, gp_Ax1(gp_Pnt(), gp_Dir(0, 0, 1)), 4.0).Shape()},
          {"extruded ellipse", BRepPrimAPI_MakePrism(ellipse, gp_Vec(1, 0, 3)).Shape()},
          {"Bezier patch", face_on(wave())},
          {"offset surface", face_on(offset)},
          {"across seams", over_seams()},
          {"cut cylinder", cut_cylinder()},
          {"drilled box", drilled_box()}};
}

}  // namespace

TopoDS_Shape drilled_box() {
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(4, 4, 2).Shape();
  BRepFilletAPI_MakeFillet rounding(box);
  for (TopExp_Explorer edge(box, TopAbs_EDGE); edge.More(); edge.Next())
    rounding.Add(0.3, TopoDS::Edge(edge.Current()));
  const TopoDS_Shape drill = BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(2, 2, -1), gp_Dir(0, 0, 1)), 0.7, 4).Shape();
  return BRepAlgoAPI_Cut(rounding.Shape(), drill).Shape();
}

TopoDS_Compound compound_of(const std::vector<TopoDS_Shape>& shapes) {
  TopoDS_Compound all;
  const BRep_Builder builder;
  builder.MakeCompound(all);
  for (const TopoDS_Shape& shape : shapes) builder.Add(all, shape);
  return all;
}

gp_Trsf shift(double x, double y, double z) {
  gp_Trsf map;
  map.SetTranslation(gp_Vec(x, y, z));
  return map;
}

std::vector<TopoDS_Face> faces_in(const TopoDS_Shape& shape) {
  std::vector<TopoDS_Face> faces;
  for (TopExp_Explorer face(shape, TopAbs_FACE); face.More(); face.Next())
    faces.push_back(TopoDS::Face(face.Current()));
  return faces;
}

std::vector<NamedShape> occt_shapes() {
  std::vector<NamedShape> out = plain_shapes();
  const TopoDS_Shape drilled = drilled_box(), cut = cut_cylinder();
  gp_Trsf turn, mirror, mirror_in_place;
  turn.SetRotation(gp_Ax1(gp_Pnt(1, 0, 0), gp_Dir(1, 2, 3)), 1.2);
  mirror.SetMirror(gp_Ax2(gp_Pnt(1, 1, 1), gp_Dir(1, 2, 0)));
  TopoDS_Shape scaled = cut, mirrored = cut;
  gp_Trsf scale;
  scale.SetScale(gp_Pnt(1, 0, 0), 2.5);
#if OCC_VERSION_HEX >= 0x070600
  scaled.Location(TopLoc_Location(scale), false);
  mirrored.Location(TopLoc_Location(mirror), false);
#else
  scaled.Location(TopLoc_Location(scale));
  mirrored.Location(TopLoc_Location(mirror));
#endif
  out.push_back({"reversed solid", drilled.Reversed()});
  out.push_back({"turned solid", drilled.Moved(turn)});
  out.push_back({"mirrored copy", BRepBuilderAPI_Transform(cut, mirror, true).Shape()});
  out.push_back({"scaled location", scaled});
  out.push_back({"mirrored location", mirrored});
  out.push_back({"two places", compound_of({cut.Moved(shift(9, 0, 0)), cut.Moved(turn)})});
  out.push_back({"two sides", compound_of({cut, cut.Moved(shift(0, 9, 0)).Reversed()})});
  const TopoDS_Compound pair = compound_of({cut, drilled.Moved(shift(0, 0, 9))});
  out.push_back({"nested places", compound_of({pair.Moved(turn), pair.Moved(shift(20, 0, 0)), drilled})});
  return out;
}

}  // namespace tessera::test
