// Shapes that cannot be triangulated, and calls that end early: the shape stays as it was.

#include <gtest/gtest.h>

#include <opencascade/BRepBuilderAPI_MakeFace.hxx>
#include <opencascade/BRepMesh_IncrementalMesh.hxx>
#include <opencascade/BRepPrimAPI_MakeBox.hxx>
#include <opencascade/BRepPrimAPI_MakeCylinder.hxx>
#include <opencascade/BRepPrimAPI_MakeSphere.hxx>
#include <opencascade/BRep_Builder.hxx>
#include <opencascade/BRep_Tool.hxx>
#include <opencascade/Geom_Plane.hxx>
#include <opencascade/Poly_Triangulation.hxx>
#include <opencascade/TopExp_Explorer.hxx>
#include <opencascade/TopoDS.hxx>
#include <opencascade/TopoDS_Compound.hxx>
#include <opencascade/TopoDS_Wire.hxx>

#include <atomic>
#include <limits>
#include <string>
#include <vector>

#include "occt/poly_checks.h"
#include "support/synthetic_sets.h"
#include "tessera/occt.h"
#include "tessera/occt_mesh.h"

namespace tessera::test { namespace {

using opencascade::handle;

TEST(TriangulateRefusals, RequestsAreChecked) {
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(1, 1, 1).Shape();
  const auto code = [](const TopoDS_Shape& shape, OcctMeshOptions options) {
    return triangulate(shape, options).status().code();
  };
  constexpr double nan = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();
  for (const double bad : {0.0, -1.0, nan, infinite}) {
    EXPECT_EQ(code(box, {.deflection = bad}), StatusCode::invalid_argument) << bad;
    EXPECT_EQ(code(box, {.deflection = bad, .relative = true}), StatusCode::invalid_argument) << bad;
  }
  for (const double bad : {0.0, -1.0, nan})
    EXPECT_EQ(code(box, {.deflection = 1, .angle = bad}), StatusCode::invalid_argument) << bad;
  EXPECT_EQ(code({}, {.deflection = 1}), StatusCode::invalid_argument);
  TopoDS_Compound empty;
  BRep_Builder().MakeCompound(empty);
  EXPECT_EQ(code(empty, {.deflection = 1}), StatusCode::invalid_argument);
  EXPECT_EQ(code(TopExp_Explorer(box, TopAbs_EDGE).Current(), {.deflection = 1}), StatusCode::invalid_argument);
  for (const handle<Poly_Triangulation>& mesh : triangulations_of(box)) EXPECT_TRUE(mesh.IsNull());
}

/// Calls that fail leave older triangulations, and the polygons on them.
TEST(TriangulateRefusals, FailuresChangeNothing) {
  const TopoDS_Shape shape = BRepPrimAPI_MakeSphere(3).Shape();
  BRepMesh_IncrementalMesh(shape, 0.1);
  const std::vector<handle<Poly_Triangulation>> before = triangulations_of(shape);
  const auto expect_same = [&] {
    EXPECT_EQ(triangulations_of(shape), before);
    TopLoc_Location place;
    for (TopExp_Explorer edge(shape, TopAbs_EDGE); edge.More(); edge.Next())
      EXPECT_FALSE(BRep_Tool::PolygonOnTriangulation(TopoDS::Edge(edge.Current()), before[0], place).IsNull());
  };
  EXPECT_EQ(triangulate(shape, {.deflection = 1e-4, .max_triangles = 1000}).status().code(),
            StatusCode::invalid_argument);
  expect_same();
  const std::atomic<bool> cancel = true;
  EXPECT_EQ(triangulate(shape, {.deflection = 1e-2}, {.cancel = &cancel}).status().code(), StatusCode::cancelled);
  expect_same();
  for (const TopAbs_ShapeEnum kind : {TopAbs_FACE, TopAbs_EDGE}) {
    const TopoDS_Shape locked = TopExp_Explorer(shape, kind).Current();
    locked.TShape()->Locked(true);
    const Status refused = triangulate(shape, {.deflection = 1e-2}).status();
    EXPECT_EQ(refused.code(), StatusCode::invalid_argument);
    EXPECT_NE(refused.message().find("locked"), std::string::npos) << refused.message();
    expect_same();
    locked.TShape()->Locked(false);
  }
  EXPECT_TRUE(triangulate(shape, {.deflection = 1e-2}).ok());
  EXPECT_NE(triangulations_of(shape), before);
}

/// Faces that cannot be converted keep what they have, and are named; the others are triangulated.
TEST(TriangulateRefusals, FacesWithoutSurfacesKeepTheirTriangles) {
  const handle<Poly_Triangulation> triangle = new Poly_Triangulation(3, 1, false);
  triangle->SetNode(1, gp_Pnt(0, 0, 0)), triangle->SetNode(2, gp_Pnt(1, 0, 0)), triangle->SetNode(3, gp_Pnt(0, 1, 0));
  triangle->SetTriangle(1, Poly_Triangle(1, 2, 3));
  const BRep_Builder builder;
  TopoDS_Face of_triangles, bare;
  builder.MakeFace(of_triangles, triangle);
  builder.MakeFace(bare);
  const TopoDS_Face plane = BRepBuilderAPI_MakeFace(new Geom_Plane(gp_Ax3()), 1e-7).Face();
  TopoDS_Compound all;
  builder.MakeCompound(all);
  for (const TopoDS_Face& face : {of_triangles, bare, plane}) builder.Add(all, face);
  EXPECT_FALSE(triangulate(all, {.deflection = 1}).ok());
  builder.Add(all, BRepPrimAPI_MakeBox(1, 1, 1).Shape());
  const OcctMeshReport report = value_of(triangulate(all, {.deflection = 1}));
  EXPECT_EQ(report.faces, 6u);
  EXPECT_FALSE(report.closed);
  ASSERT_EQ(report.left_out.size(), 3u);
  const TopoDS_Face left_out[] = {of_triangles, bare, plane};
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_TRUE(report.left_out[k].part.IsSame(left_out[k])) << report.left_out[k].reason;
    EXPECT_FALSE(report.left_out[k].reason.empty());
  }
  TopLoc_Location place;
  EXPECT_EQ(BRep_Tool::Triangulation(of_triangles, place), triangle);
  EXPECT_TRUE(BRep_Tool::Triangulation(plane, place).IsNull());
}

/// Edges that run around a circle many times would take time and memory by their number of turns.
TEST(TriangulateRefusals, EdgesThatRunAroundForEver) {
  for (const double turns : {1e5, 1e11, 1e300}) {
    const TopoDS_Shape shape = BRepPrimAPI_MakeCylinder(1, 1).Shape();
    for (TopExp_Explorer edge(shape, TopAbs_EDGE); edge.More(); edge.Next())
      BRep_Builder().Range(TopoDS::Edge(edge.Current()), 0, turns);
    const Result<OcctModel> model = model_from(shape);
    ASSERT_TRUE(model) << model.status().message();
    for (const BrepEdge& edge : model->model.shapes[0].edges)
      EXPECT_LE(edge.curve ? edge.curve->points().size() : 0, 9u) << turns;
    EXPECT_NE(triangulate(shape, {.deflection = 0.1}).status().code(), StatusCode::out_of_memory) << turns;
  }
}

/// An edge without a curve of any kind within a face.
TEST(TriangulateRefusals, EdgesWithoutGeometryBoundNothing) {
  const BRep_Builder builder;
  for (const bool relative : {false, true}) {
    const TopoDS_Shape box = BRepPrimAPI_MakeBox(1, 1, 1).Shape();
    TopoDS_Edge bare;
    builder.MakeEdge(bare);
    TopoDS_Wire wire;
    builder.MakeWire(wire);
    builder.Add(wire, bare.Oriented(TopAbs_INTERNAL));
    TopoDS_Shape face = TopExp_Explorer(box, TopAbs_FACE).Current();
    face.Free(true);
    builder.Add(face, wire);
    const Result<OcctMeshReport> report = triangulate(box, {.deflection = 0.1, .relative = relative});
    EXPECT_TRUE(report.ok()) << report.status().message();
  }
}

}}  // namespace tessera::test
