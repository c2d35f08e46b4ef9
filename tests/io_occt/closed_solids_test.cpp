// Meshes of solids are closed at every tolerance, and their volumes are those of OpenCASCADE.

#include <gtest/gtest.h>
#include <opencascade/BRepAlgoAPI_Cut.hxx>
#include <opencascade/BRepAlgoAPI_Fuse.hxx>
#include <opencascade/BRepFilletAPI_MakeFillet.hxx>
#include <opencascade/BRepGProp.hxx>
#include <opencascade/BRepPrimAPI_MakeBox.hxx>
#include <opencascade/BRepPrimAPI_MakeCone.hxx>
#include <opencascade/BRepPrimAPI_MakeCylinder.hxx>
#include <opencascade/BRepPrimAPI_MakeSphere.hxx>
#include <opencascade/BRepPrimAPI_MakeTorus.hxx>
#include <opencascade/GProp_GProps.hxx>
#include <opencascade/TopExp_Explorer.hxx>
#include <opencascade/TopoDS.hxx>

#include <algorithm>
#include <cmath>
#include <map>

#include "io_occt/cad_shapes.h"
#include "support/scratch_folder.h"
#include "tess_trim/closed_shape.h"
#include "tessera/cad.h"
#include "tessera/topology.h"

namespace tessera::test { namespace {

double volume_of(const TopoDS_Shape& shape) {
  double sum = 0;
  for (TopExp_Explorer solid(shape, TopAbs_SOLID); solid.More(); solid.Next()) {
    GProp_GProps properties;
    BRepGProp::VolumeProperties(solid.Current(), properties, 1e-9);
    sum += std::abs(properties.Mass());
  }
  return sum;
}

/// Whether all shells of a shape are closed, and each edge of its faces is used twice.
bool is_closed(const Shape& shape) {
  const std::vector<bool> closed = value_of(closed_shells(shape));
  if (closed.empty() || std::ranges::find(closed, false) != closed.end()) return false;
  const EdgeUses uses = value_of(edge_uses(shape));
  for (std::size_t edge = 0; edge < shape.edges.size(); ++edge)
    if (!shape.edges[edge].degenerate && uses[edge].size() % 2 != 0) return false;
  return true;
}

/// The sums over the instances of a model.
struct Totals {
  std::size_t closed = 0, triangles = 0;
  double volume = 0, allowed = 0, gap = 0;
};

/// Meshes a shape, and checks what is promised of it.
void add(const Shape& shape, std::size_t instances, double tolerance, Totals& totals) {
  const ShapeMesh made = mesh_of(shape, {.tolerance = tolerance, .relative = true});
  const std::string what = *shape.name + " at " + std::to_string(tolerance);
  EXPECT_EQ(made.report.non_finite_vertices, 0u) << what;
  EXPECT_EQ(made.report.t_junctions, 0u) << what;
  if (is_closed(shape)) {
    EXPECT_EQ(made.report.open_edges, 0u) << what;
    EXPECT_EQ(made.report.inconsistent_edges, 0u) << what;
    EXPECT_EQ(made.open_edges, 0u) << what;
    totals.closed += instances;
    const auto [volume, area] = volume_and_area(made.mesh);
    totals.volume += static_cast<double>(instances) * volume;
    totals.allowed += static_cast<double>(instances) * area * (made.bound + made.gap);
  } else {
    EXPECT_EQ(made.report.open_edges, made.open_edges) << what;
  }
  totals.triangles += instances * made.report.triangles;
  totals.gap = std::max(totals.gap, made.gap);
}

/// Meshes a file at ten tolerances.
void check_file(const std::filesystem::path& path) {
  const Result<DescribedShape> file = load_cad(path);
  const Result<Model> model = read_by_opencascade(path);
  if (!file || !model || model->shapes.empty()) return;
  std::map<std::uint32_t, std::size_t> instances;
  for (const Instance& instance : model->instances) ++instances[instance.shape];
  const double expected = volume_of(file->shape);
  std::printf("%s:", path.filename().c_str());
  for (int k = 0; k < 10; ++k) {
    const double tolerance = std::pow(10, -1 - k / 3.0);
    Totals totals;
    for (const auto& [shape, count] : instances) add(model->shapes[shape], count, tolerance, totals);
    if (k % 3 == 0) std::printf(" %.1e: %zu triangles, gap %.1e;", tolerance, totals.triangles, totals.gap);
    if (totals.closed < model->instances.size() || expected == 0) continue;
    EXPECT_NEAR(totals.volume, expected, totals.allowed + 1e-6 * expected) << path << ' ' << tolerance;
  }
  std::printf(" volume %.6g\n", expected);
}

// Vertices that one face needs at an edge cost triangles in the other; where faces agree, none are needed.
TEST(ClosedSolids, HaveFewMoreTrianglesThanUnconnectedFaces) {
  const std::vector<std::filesystem::path> files = real_cad_files();
  if (files.empty()) GTEST_SKIP() << "TESSERA_TEST_DATA is not set";
  for (const std::filesystem::path& path : files) {
    if (path.filename() != "as1-oc-214.stp" && path.filename() != "screw.step") continue;
    std::size_t closed = 0, open = 0;
    for (const Shape& shape : value_of(read_by_opencascade(path)).shapes) {
      const TessellationOptions options{.tolerance = 1e-4, .relative = true};
      closed += mesh_of(shape, options).report.triangles;
      TessellationOptions apart = options;
      apart.joining.close_edges = false;
      open += mesh_of(shape, apart).report.triangles;
    }
    std::printf("%s: %zu triangles closed, %zu unconnected\n", path.filename().c_str(), closed, open);
    EXPECT_LE(static_cast<double>(closed), 1.25 * static_cast<double>(open));
  }
}

TEST(ClosedSolids, OfRealFiles) {
  const std::vector<std::filesystem::path> files = real_cad_files();
  if (files.empty()) GTEST_SKIP() << "TESSERA_TEST_DATA is not set";
  for (const std::filesystem::path& path : files)
    if (path.extension() != ".igs" && path.extension() != ".iges") check_file(path);
}

TEST(ClosedSolids, OfPrimitivesAndTheirDifferences) {
  const ScratchFolder folder;
  const gp_Ax2 across(gp_Pnt(5, -1, 5), gp_Dir(0, 1, 0));
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(10, 8, 10).Shape();
  const TopoDS_Shape drill = BRepPrimAPI_MakeCylinder(across, 2, 20).Shape();
  const TopoDS_Shape pipe = BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(5, 4, -5), gp_Dir(0, 0, 1)), 2, 20).Shape();
  BRepFilletAPI_MakeFillet fillet(box);
  for (TopExp_Explorer edge(box, TopAbs_EDGE); edge.More(); edge.Next()) fillet.Add(1.5, TopoDS::Edge(edge.Current()));
  const std::map<std::string, TopoDS_Shape> shapes{
      {"ball", BRepPrimAPI_MakeSphere(3).Shape()},
      {"cone", BRepPrimAPI_MakeCone(3, 0, 5).Shape()},
      {"wedge", BRepPrimAPI_MakeCylinder(gp_Ax2(), 3, 5, 1).Shape()},
      {"torus", BRepPrimAPI_MakeTorus(5, 2, 1.0).Shape()},
      {"ring", BRepPrimAPI_MakeTorus(5, 2).Shape()},
      {"drilled", BRepAlgoAPI_Cut(box, drill).Shape()},
      {"crossing", BRepAlgoAPI_Fuse(drill, pipe).Shape()},
      {"octant", BRepAlgoAPI_Cut(BRepPrimAPI_MakeSphere(3).Shape(), BRepPrimAPI_MakeBox(5, 5, 5).Shape()).Shape()},
      {"bitten", BRepAlgoAPI_Cut(box, BRepPrimAPI_MakeSphere(gp_Pnt(10, 8, 10), 4).Shape()).Shape()},
      {"rounded", fillet.Shape()}};
  for (const auto& [name, shape] : shapes)
    for (const char* const extension : {".brep", ".step"}) {
      write_cad(shape, folder / (name + extension));
      check_file(folder / (name + extension));
    }
}

}}  // namespace tessera::test
