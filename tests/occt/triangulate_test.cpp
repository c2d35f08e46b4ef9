// Triangulations stored in OpenCASCADE's shapes: what its consumers expect of them, closed and within their bounds.

#include <gtest/gtest.h>

#include <opencascade/BRepAlgoAPI_Common.hxx>
#include <opencascade/BRepAlgoAPI_Cut.hxx>
#include <opencascade/BRepAlgoAPI_Fuse.hxx>
#include <opencascade/BRepBuilderAPI_Copy.hxx>
#include <opencascade/BRepBuilderAPI_MakeEdge.hxx>
#include <opencascade/BRepBuilderAPI_MakeFace.hxx>
#include <opencascade/BRepBuilderAPI_MakeWire.hxx>
#include <opencascade/BRepBuilderAPI_Transform.hxx>
#include <opencascade/BRepCheck_Analyzer.hxx>
#include <opencascade/BRepGProp.hxx>
#include <opencascade/BRepMesh_IncrementalMesh.hxx>
#include <opencascade/BRepPrimAPI_MakeBox.hxx>
#include <opencascade/BRepPrimAPI_MakeCone.hxx>
#include <opencascade/BRepPrimAPI_MakeCylinder.hxx>
#include <opencascade/BRepPrimAPI_MakePrism.hxx>
#include <opencascade/BRepPrimAPI_MakeRevol.hxx>
#include <opencascade/BRepPrimAPI_MakeSphere.hxx>
#include <opencascade/BRepPrimAPI_MakeTorus.hxx>
#include <opencascade/BRep_Builder.hxx>
#include <opencascade/BRep_Tool.hxx>
#include <opencascade/GProp_GProps.hxx>
#include <opencascade/Geom_BezierSurface.hxx>
#include <opencascade/Geom_OffsetSurface.hxx>
#include <opencascade/Geom_Plane.hxx>
#include <opencascade/Poly_Triangulation.hxx>
#include <opencascade/RWGltf_CafWriter.hxx>
#include <opencascade/TColStd_IndexedDataMapOfStringString.hxx>
#include <opencascade/TColgp_Array2OfPnt.hxx>
#include <opencascade/TDocStd_Document.hxx>
#include <opencascade/TopExp_Explorer.hxx>
#include <opencascade/TopoDS.hxx>
#include <opencascade/TopoDS_Compound.hxx>
#include <opencascade/XCAFApp_Application.hxx>
#include <opencascade/XCAFDoc_DocumentTool.hxx>
#include <opencascade/XCAFDoc_ShapeTool.hxx>
#include <opencascade/gp_Circ.hxx>

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "occt/poly_checks.h"
#include "support/scratch_folder.h"
#include "support/synthetic_sets.h"
#include "tessera/occt_mesh.h"

namespace tessera::test { namespace {

using opencascade::handle;

void expect_good(const TopoDS_Shape& shape, const OcctMeshReport& report, const std::string& what) {
  const PolyFacts facts = check_polys(shape, report);
  EXPECT_EQ(facts.violations, 0u) << what;
  for (const std::string& one : facts.wrong) ADD_FAILURE() << what << ": " << one;
  EXPECT_EQ(facts.triangles, report.triangles) << what;
  EXPECT_EQ(facts.nodes, report.nodes) << what;
  EXPECT_EQ(facts.faces, report.faces) << what;
}

double mass(const TopoDS_Shape& shape, bool of_triangles) {
  GProp_GProps properties;
  BRepGProp::VolumeProperties(shape, properties, false, false, of_triangles);
  return properties.Mass();
}

/// Triangulates a closed solid at several deflections and checks what is stored.
void expect_closed(const TopoDS_Shape& shape, const std::string& what, bool shares_location = true,
                   bool is_thin = false) {
  const double size = size_of(shape), volume = mass(BRepBuilderAPI_Copy(shape).Shape(), false);
  for (const double share : {1e-1, 1e-2, 1e-3, 1e-4}) {
    for (const bool relative : {false, true}) {
      const OcctMeshOptions options{.deflection = relative ? share : share * size, .relative = relative};
      const std::string here = what + " at " + std::to_string(share);
      const OcctMeshReport report = value_of(triangulate(shape, options));
      expect_good(shape, report, here);
      EXPECT_TRUE(BRepCheck_Analyzer(shape).IsValid()) << here;
      EXPECT_TRUE(report.closed) << here;
      EXPECT_TRUE(report.certified) << here;
      EXPECT_TRUE(report.open_edges.empty() && report.left_out.empty()) << here;
      EXPECT_LE(report.gap, 0.1 * share * size) << here;
      // A face whose bound exceeds its deflection is named: slivers between an edge and its chords may take all of it.
      if (!relative && report.faults.empty()) {
        EXPECT_LE(report.bound, options.deflection) << here;
      }
      EXPECT_LE(report.faults.size(), is_thin ? 1u : 0u) << here;
      const StlFacts stl = stl_facts(shape);
      if (shares_location) {
        EXPECT_EQ(stl.open_sides, 0u) << here;
      }
      const double near = stl.area * (report.bound + report.gap) + 1e-6 * std::abs(volume);
      EXPECT_NEAR(stl.volume, volume, near) << here;
      EXPECT_NEAR(mass(shape, true), volume, near) << here;
    }
  }
}

TEST(Triangulate, SolidsAreClosed) {
  expect_closed(BRepPrimAPI_MakeBox(3, 4, 5).Shape(), "box");
  expect_closed(BRepPrimAPI_MakeCylinder(2, 5).Shape(), "cylinder");
  expect_closed(BRepPrimAPI_MakeCone(2, 0, 5).Shape(), "cone");
  expect_closed(BRepPrimAPI_MakeCone(2, 1, 5).Shape(), "frustum");
  expect_closed(BRepPrimAPI_MakeSphere(2).Shape(), "sphere");
  expect_closed(BRepPrimAPI_MakeTorus(5, 1).Shape(), "torus");
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(3, 4, 5).Shape();
  expect_closed(BRepAlgoAPI_Cut(box, BRepPrimAPI_MakeCylinder(1, 9).Shape()).Shape(), "box without a cylinder");
  expect_closed(BRepAlgoAPI_Fuse(box, BRepPrimAPI_MakeSphere(gp_Pnt(3, 4, 5), 2).Shape()).Shape(), "box and sphere");
}

/// Two shapes that public reports state to have wrong meshes: a torus that a box trims across its seams, and thin parts
/// of one.
TEST(Triangulate, PartsOfATorusAreClosed) {
  const auto box = [](double x, double y, double z, double dx, double dy, double dz) {
    return BRepPrimAPI_MakeBox(gp_Pnt(x, y, z), dx, dy, dz).Shape();
  };
  const auto torus = [](double minor) { return BRepPrimAPI_MakeTorus(10, minor).Shape(); };
  // Both seams run along y = 0 at x > 0, and along the outer equator.
  expect_closed(BRepAlgoAPI_Common(torus(3), box(0, -2, -1, 20, 4, 2)).Shape(), "torus within a box across its seams");
  expect_closed(BRepAlgoAPI_Cut(torus(3), box(9, -2, -1, 20, 4, 2)).Shape(), "torus with a notch across its seams");
  for (const double thickness : {1.0, 1e-1, 1e-2}) {
    const std::string what = "part of a torus of thickness " + std::to_string(thickness);
    expect_closed(BRepAlgoAPI_Common(torus(3), box(-20, -20, 0, 40, 40, thickness)).Shape(), "flat " + what, true,
                  true);
    expect_closed(BRepAlgoAPI_Common(torus(3), box(0, 0, -20, 40, thickness, 40)).Shape(), "upright " + what, true,
                  true);
  }
  expect_closed(torus(1e-2), "thin torus");
}

/// Faces keep their own space, wherever the shapes that hold them stand.
TEST(Triangulate, FacesKeepTheirOwnSpace) {
  gp_Trsf turn, mirror;
  turn.SetRotation(gp_Ax1(gp_Pnt(1, 2, 3), gp_Dir(1, 1, 1)), 0.7);
  turn.SetTranslationPart(gp_Vec(100, -50, 25));
  mirror.SetMirror(gp_Ax2(gp_Pnt(0, 0, 7), gp_Dir(0, 0.6, 0.8)));
  const TopoDS_Shape drilled =
      BRepAlgoAPI_Cut(BRepPrimAPI_MakeBox(3, 4, 5).Shape(), BRepPrimAPI_MakeCylinder(1, 9).Shape()).Shape();
  expect_closed(drilled.Moved(TopLoc_Location(turn)), "moved");
  expect_closed(BRepBuilderAPI_Transform(drilled, mirror).Shape(), "mirrored", false);
  expect_closed(BRepBuilderAPI_Transform(drilled, mirror, true).Shape(), "mirrored copy");
  expect_closed(drilled.Reversed(), "reversed");
}

TopoDS_Shape disk(double radius) {
  return BRepBuilderAPI_MakeFace(new Geom_Plane(gp_Ax3()),
                                 BRepBuilderAPI_MakeWire(BRepBuilderAPI_MakeEdge(gp_Circ(gp_Ax2(), radius)).Edge()))
      .Shape();
}

/// Both ends of a prism, and of a part of a turn, are one face at two places.
TEST(Triangulate, SweepsWithoutCopiesAreClosed) {
  const TopoDS_Shape prism = BRepPrimAPI_MakePrism(disk(2), gp_Vec(0, 0, 5)).Shape();
  gp_Trsf aside;
  aside.SetTranslation(gp_Vec(4, 0, 0));
  const TopoDS_Shape away = BRepBuilderAPI_Transform(disk(2), aside, true).Shape();
  const TopoDS_Shape bend = BRepPrimAPI_MakeRevol(away, gp_Ax1(gp_Pnt(), gp_Dir(0, 1, 0)), 1.5).Shape();
  for (const TopoDS_Shape& shape : {prism, bend})
    for (const double deflection : {0.1, 1e-2, 1e-3}) {
      const OcctMeshReport report = value_of(triangulate(shape, {.deflection = deflection}));
      expect_good(shape, report, "sweep");
      EXPECT_TRUE(report.closed) << deflection;
      EXPECT_TRUE(report.open_edges.empty() && report.faults.empty()) << deflection;
    }
}

/// A hole near one end gives that end's edge nodes that the other end's has not.
TEST(Triangulate, EndsThatDifferAreSaidToBeOpen) {
  const TopoDS_Shape prism = BRepPrimAPI_MakePrism(disk(2), gp_Vec(0, 0, 5)).Shape();
  const gp_Ax2 across(gp_Pnt(-5, 0, 0.9), gp_Dir(1, 0.3, 0));
  const TopoDS_Shape drilled = BRepAlgoAPI_Cut(prism, BRepPrimAPI_MakeCylinder(across, 0.3, 10).Shape()).Shape();
  bool differs = false;
  for (const double deflection : {0.1, 1e-2, 1e-3}) {
    const OcctMeshReport report = value_of(triangulate(drilled, {.deflection = deflection}));
    const bool is_open = stl_facts(drilled).open_sides > 0;
    EXPECT_EQ(report.closed, !is_open) << deflection;
    EXPECT_EQ(report.open_edges.empty(), !is_open) << deflection;
    EXPECT_EQ(report.faults.empty(), !is_open) << deflection;
    differs = differs || is_open;
  }
  EXPECT_TRUE(differs);  // or else the test shows nothing
}

/// Borders move by a share of the deflection, whatever the size of a shape.
TEST(Triangulate, GapsFollowTheDeflection) {
  for (const double radius : {1.0, 1e2, 1e4, 1e6}) {
    const gp_Ax2 oblique(gp_Pnt(0, 0, radius), gp_Dir(0.3, 0, 1));
    const TopoDS_Shape half = BRepPrimAPI_MakeBox(oblique, 9 * radius, 9 * radius, 9 * radius).Shape();
    gp_Trsf back;
    back.SetTranslation(gp_Vec(-4 * radius, -4 * radius, 0));
    const TopoDS_Shape tool = BRepBuilderAPI_Transform(half, back, true).Shape();
    for (const TopoDS_Shape& whole : {BRepPrimAPI_MakeCone(radius, radius / 2, 2 * radius).Shape(),
                                      BRepPrimAPI_MakeCylinder(radius, 2 * radius).Shape()}) {
      const TopoDS_Shape shape = BRepAlgoAPI_Cut(whole, tool).Shape();
      for (const double share : {1e-2, 1e-4, 1e-6}) {
        const double deflection = share * radius;
        const OcctMeshReport report = value_of(triangulate(shape, {.deflection = deflection}));
        EXPECT_TRUE(report.closed) << radius;
        EXPECT_LE(report.gap, 0.02 * deflection + 4e-7) << radius;  // OpenCASCADE's cut has a tolerance of its own
      }
    }
  }
}

/// A surface that is fitted counts with its error, at its face too.
TEST(Triangulate, FitsCountInTheDeflection) {
  TColgp_Array2OfPnt poles(1, 3, 1, 3);
  for (int i = 1; i <= 3; ++i)
    for (int j = 1; j <= 3; ++j) poles(i, j) = gp_Pnt(i, j, i == 2 && j == 2 ? 1.5 : 0.2 * i);
  const handle<Geom_Surface> wave = new Geom_OffsetSurface(new Geom_BezierSurface(poles), 0.25);
  const TopoDS_Face face = BRepBuilderAPI_MakeFace(wave, 1e-7).Face();
  const OcctMeshReport report = value_of(triangulate(face, {.deflection = 1e-6}));
  TopLoc_Location place;
  EXPECT_FALSE(report.certified);
  EXPECT_FALSE(report.faults.empty());
  EXPECT_GE(BRep_Tool::Triangulation(face, place)->Deflection(), 0.999 * report.bound);
}

/// A shape that stands at several places is triangulated once, and all its places show it.
TEST(Triangulate, SharedShapesAreTriangulatedOnce) {
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(3, 4, 5).Shape();
  const BRep_Builder builder;
  TopoDS_Compound all;
  builder.MakeCompound(all);
  for (int k = 0; k < 4; ++k) {
    gp_Trsf move;
    move.SetTranslation(gp_Vec(10 * k, 0, 0));
    builder.Add(all, box.Moved(TopLoc_Location(move)));
  }
  const OcctMeshReport report = value_of(triangulate(all, {.deflection = 0.1}));
  EXPECT_EQ(report.faces, 6u);
  EXPECT_EQ(report.triangles, 12u);
  EXPECT_TRUE(report.closed);
  const std::vector<handle<Poly_Triangulation>> own = triangulations_of(all);
  ASSERT_EQ(own.size(), 24u);
  for (std::size_t k = 0; k < own.size(); ++k) EXPECT_EQ(own[k], own[k % 6]);
  EXPECT_EQ(stl_facts(all).open_sides, 0u);
  EXPECT_NEAR(stl_facts(all).volume, 240, 1e-3);
}

/// Solids that share a face have the same nodes along it.
TEST(Triangulate, GluedSolidsMeet) {
  const TopoDS_Shape left = BRepPrimAPI_MakeBox(gp_Pnt(-3, 0, 0), gp_Pnt(0, 4, 5)).Shape();
  const TopoDS_Shape right = BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(0, 2, 2), gp_Dir(1, 0, 0)), 1.5, 4).Shape();
  const TopoDS_Shape both = BRepAlgoAPI_Fuse(left, right).Shape();
  expect_closed(both, "box and cylinder");
}

TEST(Triangulate, ReplacesOlderTriangulations) {
  const TopoDS_Shape shape = BRepPrimAPI_MakeTorus(5, 1).Shape();
  BRepMesh_IncrementalMesh(shape, 0.5);
  const std::vector<handle<Poly_Triangulation>> before = triangulations_of(shape);
  expect_good(shape, value_of(triangulate(shape, {.deflection = 1e-3})), "torus");
  const std::vector<handle<Poly_Triangulation>> after = triangulations_of(shape);
  for (std::size_t k = 0; k < before.size(); ++k) EXPECT_NE(before[k], after[k]);
  // No edge keeps a polygon on the triangulations that are gone.
  TopLoc_Location place;
  for (TopExp_Explorer edge(shape, TopAbs_EDGE); edge.More(); edge.Next())
    for (const handle<Poly_Triangulation>& one : before)
      EXPECT_TRUE(BRep_Tool::PolygonOnTriangulation(TopoDS::Edge(edge.Current()), one, place).IsNull());
}

TEST(Triangulate, ResultDoesNotDependOnThreads) {
  const TopoDS_Shape shape =
      BRepAlgoAPI_Cut(BRepPrimAPI_MakeSphere(4).Shape(), BRepPrimAPI_MakeCylinder(1, 9).Shape()).Shape();
  const TopoDS_Shape copy = BRepBuilderAPI_Copy(shape).Shape();
  const OcctMeshReport one = value_of(triangulate(shape, {.deflection = 1e-3, .parallel = false}));
  const OcctMeshReport many = value_of(triangulate(copy, {.deflection = 1e-3}));
  EXPECT_EQ(one.triangles, many.triangles);
  EXPECT_EQ(one.bound, many.bound);
  const auto first = triangulations_of(shape), second = triangulations_of(copy);
  ASSERT_EQ(first.size(), second.size());
  for (std::size_t k = 0; k < first.size(); ++k) {
    ASSERT_EQ(first[k]->NbNodes(), second[k]->NbNodes());
    for (int node = 1; node <= first[k]->NbNodes(); ++node)
      EXPECT_EQ(first[k]->Node(node).Distance(second[k]->Node(node)), 0);
  }
}

/// Deflections that floats cannot keep take nodes in double.
TEST(Triangulate, TinyDeflectionsAreKept) {
  const TopoDS_Shape shape = BRepPrimAPI_MakeCylinder(1, 1e4).Shape();
  const OcctMeshReport report = value_of(triangulate(shape, {.deflection = 1e-6}));
  EXPECT_LE(report.bound, 1e-6);
  EXPECT_TRUE(report.closed && report.faults.empty());
  expect_good(shape, report, "long cylinder");
}

TEST(Triangulate, AnglesAreKept) {
  const TopoDS_Shape shape = BRepPrimAPI_MakeCylinder(1, 1).Shape();
  EXPECT_LT(value_of(triangulate(shape, {.deflection = 10, .angle = {}})).triangles, 40u);
  for (const double angle : {1.0, 0.1, 0.01}) {
    const OcctMeshReport report = value_of(triangulate(shape, {.deflection = 10, .angle = angle}));
    EXPECT_LE(report.angle, angle);
    EXPECT_GT(static_cast<double>(report.triangles), 4 * 3.14 / angle);
    expect_good(shape, report, "cylinder");
  }
}

TEST(Triangulate, OpenShapesSayWhere) {
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(3, 4, 5).Shape();
  const BRep_Builder builder;
  TopoDS_Compound five;
  builder.MakeCompound(five);
  int k = 0;
  for (TopExp_Explorer face(box, TopAbs_FACE); face.More(); face.Next())
    if (k++ > 0) builder.Add(five, face.Current());
  const OcctMeshReport report = value_of(triangulate(five, {.deflection = 0.1}));
  EXPECT_FALSE(report.closed);
  EXPECT_EQ(report.open_edges.size(), 4u);
  EXPECT_EQ(stl_facts(five).open_sides, 4u);
}

TEST(Triangulate, GltfIsWritten) {
  const TopoDS_Shape shape = BRepPrimAPI_MakeTorus(5, 1).Shape();
  const OcctMeshReport report = value_of(triangulate(shape, {.deflection = 1e-2}));
  handle<TDocStd_Document> document;
  XCAFApp_Application::GetApplication()->NewDocument("BinXCAF", document);
  XCAFDoc_DocumentTool::ShapeTool(document->Main())->AddShape(shape);
  const ScratchFolder folder;
  RWGltf_CafWriter writer((folder / "torus.glb").c_str(), true);
  ASSERT_TRUE(writer.Perform(document, {}, {}));
  // Positions and normals of 12 bytes for each node, and indices of at least 2 bytes.
  EXPECT_GT(std::filesystem::file_size(folder / "torus.glb"), 24 * report.nodes + 6 * report.triangles);
}

}}  // namespace tessera::test
