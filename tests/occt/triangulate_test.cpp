// Triangulations stored in OpenCASCADE's shapes: what its consumers expect of them, closed and within their bounds.

#include <gtest/gtest.h>

#include <opencascade/BRepAlgoAPI_Cut.hxx>
#include <opencascade/BRepBndLib.hxx>
#include <opencascade/BRepCheck_Analyzer.hxx>
#include <opencascade/BRepGProp.hxx>
#include <opencascade/BRepPrimAPI_MakeBox.hxx>
#include <opencascade/BRepPrimAPI_MakeCone.hxx>
#include <opencascade/BRepPrimAPI_MakeCylinder.hxx>
#include <opencascade/BRepPrimAPI_MakeSphere.hxx>
#include <opencascade/BRepPrimAPI_MakeTorus.hxx>
#include <opencascade/Bnd_Box.hxx>
#include <opencascade/GProp_GProps.hxx>

#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "io_occt/cad_shapes.h"
#include "occt/poly_checks.h"
#include "support/synthetic_sets.h"
#include "tessera/occt_mesh.h"

namespace tessera::test { namespace {

double size_of(const TopoDS_Shape& shape) {
  Bnd_Box box;
  BRepBndLib::Add(shape, box, false);
  return box.IsVoid() ? 0 : std::sqrt(box.SquareExtent());
}

double volume_of(const TopoDS_Shape& shape) {
  GProp_GProps properties;
  BRepGProp::VolumeProperties(shape, properties, false, false, false);
  return properties.Mass();
}

void expect_good(const TopoDS_Shape& shape, const OcctMeshReport& report, const char* what) {
  const PolyFacts facts = check_polys(shape, report);
  EXPECT_EQ(facts.violations, 0u) << what;
  for (const std::string& one : facts.wrong) ADD_FAILURE() << what << ": " << one;
  EXPECT_EQ(facts.triangles, report.triangles) << what;
  EXPECT_EQ(facts.nodes, report.nodes) << what;
}

/// Triangulates a closed solid at several deflections and checks what is stored.
void expect_closed(const TopoDS_Shape& shape, const char* what) {
  const double size = size_of(shape), volume = volume_of(shape);
  for (const double share : {1e-1, 1e-2, 1e-3, 1e-4}) {
    for (const bool relative : {false, true}) {
      const OcctMeshOptions options{.deflection = relative ? share : share * size, .relative = relative};
      const OcctMeshReport report = value_of(triangulate(shape, options));
      expect_good(shape, report, what);
      EXPECT_TRUE(report.closed) << what << " at " << share;
      EXPECT_TRUE(report.open_edges.empty()) << what;
      if (!relative) {
        EXPECT_LE(report.bound, options.deflection) << what;
      }
      const StlFacts stl = stl_facts(shape);
      EXPECT_EQ(stl.open_sides, 0u) << what << " at " << share;
      EXPECT_NEAR(stl.volume, volume, stl.area * (report.bound + report.gap) + 1e-6 * std::abs(volume)) << what;
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
  expect_closed(BRepAlgoAPI_Cut(BRepPrimAPI_MakeBox(3, 4, 5).Shape(), BRepPrimAPI_MakeCylinder(1, 9).Shape()).Shape(),
                "box without a cylinder");
}

TEST(TriangulateFiles, AllFilesOfTheData) {
  const char* const only = std::getenv("TESSERA_ONLY");
  for (const std::filesystem::path& path : {std::filesystem::path(only)}) {
    const Result<DescribedShape> file = load_cad(path);
    if (!file || file->shape.IsNull()) continue;
    const double size = size_of(file->shape);
    const Result<OcctMeshReport> made = triangulate(file->shape, {.deflection = 1e-3 * size});
    if (!made) {
      std::printf("%-40s %s\n", path.filename().c_str(), made.status().message().c_str());
      continue;
    }
    const PolyFacts facts = check_polys(file->shape, *made);
    const StlFacts stl = stl_facts(file->shape);
    std::printf("%-40s %zu faces, %zu left out, %zu faults, %zu tri, %s, open edges %zu, STL open %zu, bound %.1e gap %.1e node %.1e edge %.1e; %zu wrong\n",
                path.filename().c_str(), made->faces, made->left_out.size(), made->faults.size(), made->triangles,
                made->closed ? "closed" : "open", made->open_edges.size(), stl.open_sides, made->bound / size,
                made->gap / size, facts.worst_node / size, facts.worst_edge / size, facts.violations);
    for (const auto& one : facts.wrong) std::printf("    %s\n", one.c_str());
    for (const auto& one : made->left_out) std::printf("    left out: %s\n", one.reason.c_str());
    for (const auto& one : made->faults) std::printf("    fault: %s\n", one.reason.c_str());
    std::fflush(stdout);
  }
}

}}  // namespace tessera::test
