// Solids, shells, edges and vertices are those of OpenCASCADE's own maps, and faces meet along edges as they do there.

#include <gtest/gtest.h>
#include <opencascade/BRepAlgoAPI_Cut.hxx>
#include <opencascade/BRepBuilderAPI_MakeFace.hxx>
#include <opencascade/BRepBuilderAPI_Transform.hxx>
#include <opencascade/BRepPrimAPI_MakeBox.hxx>
#include <opencascade/BRepPrimAPI_MakeCone.hxx>
#include <opencascade/BRepPrimAPI_MakeCylinder.hxx>
#include <opencascade/BRepPrimAPI_MakeSphere.hxx>
#include <opencascade/BRepPrimAPI_MakeTorus.hxx>
#include <opencascade/BRep_Builder.hxx>
#include <opencascade/BRep_Tool.hxx>
#include <opencascade/Geom2d_Curve.hxx>
#include <opencascade/Geom_Surface.hxx>
#include <opencascade/TopExp.hxx>
#include <opencascade/TopExp_Explorer.hxx>
#include <opencascade/TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <opencascade/TopTools_IndexedMapOfShape.hxx>
#include <opencascade/TopoDS.hxx>
#include <opencascade/TopoDS_Compound.hxx>

#include <algorithm>
#include <map>
#include <set>
#include <sstream>

#include "io_occt/cad_shapes.h"
#include "support/scratch_folder.h"
#include "support/synthetic_sets.h"
#include "tessera/cad.h"
#include "tessera/topology.h"

namespace tessera::test { namespace {

struct TopologyCounts {
  std::size_t faces = 0, solids = 0, shells = 0, closed = 0, edges = 0, vertices = 0, degenerate = 0;
  std::map<std::size_t, std::size_t> by_uses;  ///< number of coedges -> edges that are not degenerate
  friend bool operator==(const TopologyCounts&, const TopologyCounts&) = default;
};

std::ostream& operator<<(std::ostream& out, const TopologyCounts& c) {
  out << c.faces << " faces, " << c.solids << " solids, " << c.shells << " shells (" << c.closed << " closed), "
      << c.edges << " edges (" << c.degenerate << " degenerate), " << c.vertices << " vertices;";
  for (const auto& [uses, edges] : c.by_uses) out << ' ' << edges << " of " << uses;
  return out;
}

TopologyCounts topology_counts_of(const Model& model) {
  TopologyCounts all;
  for (const Instance& instance : model.instances) {
    const Shape& shape = model.shapes[instance.shape];
    const std::vector<bool> closed = value_of(closed_shells(shape));
    all.faces += shape.faces.size();
    all.solids += shape.solid_count;
    all.shells += shape.shells.size();
    all.closed += static_cast<std::size_t>(std::count(closed.begin(), closed.end(), true));
    all.edges += shape.edges.size();
    all.vertices += shape.vertices.size();
    const EdgeUses uses = value_of(edge_uses(shape));
    for (std::size_t k = 0; k < shape.edges.size(); ++k) {
      all.degenerate += shape.edges[k].degenerate;
      if (!shape.edges[k].degenerate) ++all.by_uses[uses[k].size()];
    }
  }
  return all;
}

std::size_t count(const TopoDS_Shape& shape, TopAbs_ShapeEnum kind) {
  TopTools_IndexedMapOfShape map;
  TopExp::MapShapes(shape, kind, map);
  return static_cast<std::size_t>(map.Extent());
}

/// By OpenCASCADE alone, of all that belongs to faces.
TopologyCounts topology_counts_of(const TopoDS_Shape& shape) {
  TopologyCounts all;
  all.solids = count(shape, TopAbs_SOLID);
  TopTools_IndexedMapOfShape edges, vertices, shells;
  std::vector<std::size_t> uses;
  for (const TopoDS_Face& face : faces_of(shape)) {
    ++all.faces;
    TopExp::MapShapes(face, TopAbs_EDGE, edges);
    TopExp::MapShapes(face, TopAbs_VERTEX, vertices);
    for (TopExp_Explorer edge(face, TopAbs_EDGE); edge.More(); edge.Next()) {
      uses.resize(static_cast<std::size_t>(edges.Extent()) + 1);
      ++uses[static_cast<std::size_t>(edges.FindIndex(edge.Current()))];
    }
  }
  all.edges = static_cast<std::size_t>(edges.Extent());
  all.vertices = static_cast<std::size_t>(vertices.Extent());
  for (int k = 1; k <= edges.Extent(); ++k) {
    const bool degenerate = BRep_Tool::Degenerated(TopoDS::Edge(edges(k)));
    all.degenerate += degenerate;
    if (!degenerate) ++all.by_uses[uses[static_cast<std::size_t>(k)]];
  }
  TopExp::MapShapes(shape, TopAbs_SHELL, shells);
  all.shells = static_cast<std::size_t>(shells.Extent());
  for (int k = 1; k <= shells.Extent(); ++k) all.closed += BRep_Tool::IsClosed(shells(k));
  return all;
}

/// The largest distance of two faces at equal parameters of an edge, by OpenCASCADE alone.
double gap_of(const TopoDS_Shape& shape, int samples) {
  std::map<int, std::vector<std::vector<gp_Pnt>>> points;  // of each edge, by coedges
  TopTools_IndexedMapOfShape edges;
  for (const TopoDS_Face& given : faces_of(shape)) {
    const TopoDS_Face face = TopoDS::Face(given.Oriented(TopAbs_FORWARD));
    const opencascade::handle<Geom_Surface> surface = BRep_Tool::Surface(face);
    for (TopExp_Explorer edge(face, TopAbs_EDGE); edge.More(); edge.Next()) {
      double from = 0, to = 0;
      const auto curve = BRep_Tool::CurveOnSurface(TopoDS::Edge(edge.Current()), face, from, to);
      if (curve.IsNull()) continue;
      std::vector<gp_Pnt>& line = points[edges.Add(edge.Current())].emplace_back();
      for (int k = 0; k < samples; ++k) {
        const gp_Pnt2d uv = curve->Value(from + (to - from) * k / (samples - 1));
        line.push_back(surface->Value(uv.X(), uv.Y()));
      }
    }
  }
  double largest = 0;
  for (const auto& [edge, lines] : points)
    for (const auto& a : lines)
      for (const auto& b : lines)
        for (std::size_t k = 0; k < a.size(); ++k) largest = std::max(largest, a[k].Distance(b[k]));
  return largest;
}

double gap_of(const Model& model, int samples) {
  double largest = 0;
  for (const Shape& shape : model.shapes)
    for (const double gap : value_of(edge_gaps(shape, samples))) largest = std::max(largest, gap);
  return largest;
}

double topology_size_of(const Model& model) {
  Box3 box;
  for (const ModelSurface& surface : model.surfaces)
    for (const Vec3& p : std::get<BSplineSurface>(surface.surface).points()) box.extend(surface.placement->point(p));
  return box.diagonal();
}

/// Compares counts, places of vertices, and gaps.
void compare(const std::string& path) {
  const Result<DescribedShape> file = load_cad(path);
  ASSERT_TRUE(file.ok()) << file.status().message();
  const Result<Model> model = read_by_opencascade(path);
  ASSERT_TRUE(model.ok()) << model.status().message();
  ASSERT_TRUE(check_topology(*model).ok());
  const TopologyCounts ours = topology_counts_of(*model), theirs = topology_counts_of(file->shape);
  EXPECT_EQ(ours, theirs) << path;
  constexpr int samples = 257;
  const double size = topology_size_of(*model), gap = gap_of(*model, samples), their_gap = gap_of(file->shape, samples);
  const double fit = 3e-8 * size;  // of cubics where splines run through the parameters of arcs
  EXPECT_LE(gap, 1.05 * their_gap + fit) << path;
  EXPECT_GE(gap, 0.95 * their_gap - fit) << path;
  std::ostringstream line;
  line << ours;
  std::printf("%s: %zu shapes, %zu instances; %s; gap %.2g of %.3g, theirs %.2g\n",
              std::filesystem::path(path).filename().c_str(), model->shapes.size(), model->instances.size(),
              line.str().c_str(), gap, size, their_gap);
}

TEST(Topology, OfRealFilesIsOpenCascades) {
  const std::vector<std::filesystem::path> files = real_cad_files();
  if (files.empty()) GTEST_SKIP() << "TESSERA_TEST_DATA is not set";
  for (const char* const name :
       {"as1-oc-214.stp", "as1_pe_203.stp", "face_recognition_sample_part.stp", "screw.step", "nurbsjl_torus.stp",
        "occt_hammer.iges", "igesio_input.igs", "bottle.brep", "ap214_periodic_edge_propagation.stp"})
    for (const std::filesystem::path& path : files)
      if (path.filename() == name) compare(path);
}

TEST(Topology, PartsOfAnAssemblyAreReadOnce) {
  const std::vector<std::filesystem::path> files = real_cad_files();
  if (files.empty()) GTEST_SKIP() << "TESSERA_TEST_DATA is not set";
  for (const std::filesystem::path& path : files) {
    if (path.filename() != "as1-oc-214.stp") continue;
    const Model model = value_of(read_by_opencascade(path));
    ASSERT_EQ(model.shapes.size(), 5u);
    ASSERT_EQ(model.instances.size(), 18u);
    std::map<std::string, std::size_t> placed;
    for (const Instance& instance : model.instances) ++placed[model.shapes[instance.shape].name];
    EXPECT_EQ(placed, (std::map<std::string, std::size_t>{
                          {"plate", 1}, {"l-bracket", 2}, {"bolt", 6}, {"rod", 1}, {"nut", 8}}));
    for (const Shape& shape : model.shapes) EXPECT_EQ(shape.solid_count, 1u) << *shape.name;
    EXPECT_EQ(model.unit, "mm");
    std::set<std::string> names;
    for (const Instance& instance : model.instances) names.insert(instance.name);
    EXPECT_EQ(names, (std::set<std::string>{"bolt_1", "l-bracket_1", "nut_1", "nut_2", "nut_3", "plate_1", "rod_1"}));
    EXPECT_EQ(model.file_unit, "millimetre");
  }
}

/// Shapes with seams, poles, arcs that are divided differently on both sides, and reversed faces.
TEST(Topology, OfPrimitivesAndTheirDifferences) {
  const ScratchFolder folder;
  const gp_Ax2 across(gp_Pnt(5, -1, 5), gp_Dir(0, 1, 0));
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(10, 8, 10).Shape();
  const TopoDS_Shape drill = BRepPrimAPI_MakeCylinder(across, 2, 20).Shape();
  const TopoDS_Shape corner = BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(0, 0, -1), gp_Dir(0, 0, 1)), 3, 20).Shape();
  const std::map<std::string, TopoDS_Shape> shapes{
      {"ball", BRepPrimAPI_MakeSphere(3).Shape()},
      {"cone", BRepPrimAPI_MakeCone(3, 0, 5).Shape()},
      {"wedge", BRepPrimAPI_MakeCylinder(gp_Ax2(), 3, 5, 1).Shape()},
      {"torus", BRepPrimAPI_MakeTorus(5, 2, 1.0).Shape()},
      {"drilled", BRepAlgoAPI_Cut(BRepAlgoAPI_Cut(box, drill).Shape(), corner).Shape()},
      {"bitten", BRepAlgoAPI_Cut(box, BRepPrimAPI_MakeSphere(gp_Pnt(10, 8, 10), 4).Shape()).Shape()}};
  for (const auto& [name, shape] : shapes)
    for (const char* const extension : {".brep", ".step"}) {
      write_cad(shape, folder / (name + extension));
      compare(folder / (name + extension));
    }
}

TEST(Topology, CompoundsAreOneShapeUnlessAPartRepeats) {
  const ScratchFolder folder;
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(1, 1, 1).Shape(), ball = BRepPrimAPI_MakeSphere(3).Shape();
  gp_Trsf move;
  move.SetTranslation(gp_Vec(5, 0, 0));
  TopoDS_Compound once, twice, both;
  BRep_Builder builder;
  for (TopoDS_Compound* const compound : {&once, &twice, &both}) builder.MakeCompound(*compound);
  for (const TopoDS_Shape& shape : {box, ball}) builder.Add(once, shape);
  for (const TopoDS_Shape& shape : {box, ball, box.Moved(move)}) builder.Add(twice, shape);
  for (const TopoDS_Shape& shape : {TopoDS_Shape(once), once.Moved(move)}) builder.Add(both, shape);
  const auto read = [&](const TopoDS_Shape& shape) {
    write_cad(shape, folder / "a.brep");
    compare(folder / "a.brep");
    return value_of(read_by_opencascade(folder / "a.brep"));
  };
  const Model one = read(once), three = read(twice), two = read(both);
  EXPECT_EQ(one.shapes.size(), 1u);
  EXPECT_EQ(one.instances.size(), 1u);
  EXPECT_EQ(one.shapes[0].solid_count, 2u);
  ASSERT_EQ(three.shapes.size(), 2u);
  ASSERT_EQ(three.instances.size(), 3u);
  EXPECT_EQ(three.instances[0].shape, three.instances[2].shape);
  EXPECT_EQ(three.instances[2].placement, Affine::translated({5, 0, 0}));
  EXPECT_EQ(&*three.surfaces[0].name, &*three.surfaces[7].name);
  ASSERT_EQ(two.shapes.size(), 1u);
  EXPECT_EQ(two.instances.size(), 2u);
  EXPECT_EQ(two.unit, "");
}

TEST(Topology, SolidsThatShareAFaceAreOneShape) {
  // Cuts a box into two, which keep the face between them.
  const ScratchFolder folder;
  BRep_Builder builder;
  TopoDS_Compound compound;
  builder.MakeCompound(compound);
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(1, 1, 1).Shape();
  builder.Add(compound, box);
  builder.Add(compound, box.Reversed());
  write_cad(compound, folder / "a.brep");
  const Model model = value_of(read_by_opencascade(folder / "a.brep"));
  ASSERT_EQ(model.shapes.size(), 1u);
  EXPECT_EQ(model.surfaces.size(), 12u);
  for (const auto& [uses, edges] : topology_counts_of(model).by_uses) EXPECT_EQ(uses, 4u) << edges;
}

}}  // namespace tessera::test
