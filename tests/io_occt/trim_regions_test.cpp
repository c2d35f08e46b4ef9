// The regions of trimmed CAD faces are OpenCASCADE's: points are compared with BRepTopAdaptor_FClass2d.

#include <gtest/gtest.h>
#include <opencascade/BRepAlgoAPI_Common.hxx>
#include <opencascade/BRepAlgoAPI_Cut.hxx>
#include <opencascade/BRepAlgoAPI_Fuse.hxx>
#include <opencascade/BRepPrimAPI_MakeBox.hxx>
#include <opencascade/BRepPrimAPI_MakeCone.hxx>
#include <opencascade/BRepPrimAPI_MakeCylinder.hxx>
#include <opencascade/BRepPrimAPI_MakeSphere.hxx>
#include <opencascade/BRepPrimAPI_MakeTorus.hxx>
#include <opencascade/BRepTopAdaptor_FClass2d.hxx>
#include <opencascade/BRep_Tool.hxx>
#include <opencascade/Standard_Failure.hxx>
#include <opencascade/TopoDS.hxx>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <random>
#include <set>

#include "io_occt/cad_shapes.h"
#include "occt/face_loops.h"
#include "occt/face_surface.h"
#include "support/scratch_folder.h"
#include "tessera/cad.h"
#include "tessera/convert.h"
#include "tessera/trim_region.h"

namespace tessera::test { namespace {

struct TrimRegionsCounts {
  std::size_t faces = 0, trimmed = 0, points = 0, on = 0, beside = 0, wrong = 0, unread = 0;
  std::set<LoopFault> faults;
};

/// Whether both ends of a direction are one line of the surface.
bool trim_regions_is_closed(const BSplineSurface& s, bool along_u) {
  const Domain& d = s.domain();
  double gap = 0, size = 0;
  for (int k = 0; k <= 8; ++k) {
    const double x = along_u ? d.v_at(k / 8.0) : d.u_at(k / 8.0);
    const Vec3 a = evaluate_jet(s, along_u ? d.u0 : x, along_u ? x : d.v0).position;
    const Vec3 b = evaluate_jet(s, along_u ? d.u1 : x, along_u ? x : d.v1).position;
    const Vec3 middle = evaluate_jet(s, d.u_at(0.5), d.v_at(k / 8.0)).position;
    gap = std::max(gap, length(a - b));
    size = std::max(size, length(a - middle));
  }
  return gap <= 1e-7 * size;
}

/// The distance of a point from the loops, in shares of the domain's sides.
double distance_from(const std::vector<TrimLoop>& loops, const Domain& d, double u, double v) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const TrimLoop& loop : loops)
    for (const Curve& curve : loop.curves)
      for (int k = 0; k <= 500; ++k) {
        const Vec3 p = position(curve, curve.domain().from + (curve.domain().to - curve.domain().from) * k / 500);
        nearest = std::min(nearest, std::hypot((p.x - u) / (d.u1 - d.u0), (p.y - v) / (d.v1 - d.v0)));
      }
  return nearest;
}

/// Compares `count` random points of a face.
void trim_regions_compare(const TopoDS_Face& given, int count, std::mt19937_64& random, TrimRegionsCounts& counts,
                          const std::string& where) {
  const TopoDS_Face face = TopoDS::Face(given.Oriented(TopAbs_FORWARD));
  const FaceBorder border = face_border(face);
  const Result<FaceBox> box = face_box(border);
  TopLoc_Location ignored;
  const Result<FaceSurface> made = box ? face_surface(BRep_Tool::Surface(face, ignored), box->domain) : box.status();
  const Result<ShapeEdges> edges = ShapeEdges::make(face, {});
  ASSERT_TRUE(edges.ok()) << where;
  const Result<FaceLoops> all = made ? face_loops(border, *box, made->parameters, *edges) : made.status();
  if (!all) {
    ++counts.unread;
    return;
  }
  const std::vector<TrimLoop> loops = all->whole ? std::vector<TrimLoop>() : all->loops;
  const Result<PatchGrid> grid = to_bezier(Surface(made->surface));
  ASSERT_TRUE(grid.ok()) << where;
  const Result<TrimRegion> region = TrimRegion::make(loops, grid->breaks_u(), grid->breaks_v(),
                                                     {.periodic_u = trim_regions_is_closed(made->surface, true),
                                                      .periodic_v = trim_regions_is_closed(made->surface, false)});
  ASSERT_TRUE(region.ok()) << where << region.status().message();
  ++counts.faces;
  counts.trimmed += !region->is_whole();
  for (const LoopRemark& remark : region->remarks()) counts.faults.insert(remark.fault);
  const BRepTopAdaptor_FClass2d classifier(face, 1e-9);
  const Domain &d = box->domain, ours = region->domain();
  std::uniform_real_distribution<double> unit(0, 1);
  for (int k = 0; k < count; ++k) {
    const double u = d.u_at(unit(random)), v = d.v_at(unit(random));
    const std::array<double, 2> uv = made->parameters(u, v);
    const TrimSide found = region->locate(uv[0], uv[1]);
    const TopAbs_State state = classifier.Perform(gp_Pnt2d(u, v), true);
    if (state == TopAbs_ON || found == TrimSide::border) {
      ++counts.on;
      continue;
    }
    ++counts.points;
    if ((state == TopAbs_IN) == (found == TrimSide::inside)) continue;
    // Its polygons follow the curves to within some hundredths of a per cent of the face; so do its tolerances.
    const bool beside = distance_from(loops, ours, uv[0], uv[1]) < 5e-3;
    ++(beside ? counts.beside : counts.wrong);
    if (!beside && counts.wrong <= 5)
      std::printf("%s: (%.17g, %.17g) is %s\n", where.c_str(), u, v, state == TopAbs_IN ? "inside" : "outside");
  }
}

void compare_all(const TopoDS_Shape& shape, int count, std::mt19937_64& random, TrimRegionsCounts& counts,
                 const std::string& where) {
  std::size_t k = 0;
  for (const TopoDS_Face& face : faces_of(shape)) {
    try {
      trim_regions_compare(face, count, random, counts, where + " face " + std::to_string(k++));
    } catch (const Standard_Failure&) {
      ++counts.unread;
    }
  }
}

void print(const char* what, const TrimRegionsCounts& counts) {
  std::printf(
      "%s: %zu faces, %zu of them trimmed, %zu unread; %zu points, %zu on borders, %zu differ beside a curve, "
      "%zu elsewhere\n",
      what, counts.faces, counts.trimmed, counts.unread, counts.points, counts.on, counts.beside, counts.wrong);
}

TopoDS_Shape cylinder(const gp_Pnt& at, const gp_Dir& along, double radius, double height) {
  return BRepPrimAPI_MakeCylinder(gp_Ax2(at, along), radius, height).Shape();
}

/// Solids whose faces are cut by planes, circles, and curves of degree four, over seams and around poles.
std::vector<std::pair<std::string, TopoDS_Shape>> solids() {
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(gp_Pnt(0, 0, 0), 10, 8, 3).Shape();
  const TopoDS_Shape drilled = BRepAlgoAPI_Cut(box, cylinder({4, 4, -1}, {0, 0, 1}, 1.5, 9)).Shape();
  const TopoDS_Shape bitten = BRepAlgoAPI_Cut(drilled, BRepPrimAPI_MakeSphere(gp_Pnt(10, 8, 3), 2).Shape()).Shape();
  const TopoDS_Shape ball = BRepPrimAPI_MakeSphere(gp_Pnt(0, 0, 0), 3).Shape();
  const TopoDS_Shape torus = BRepPrimAPI_MakeTorus(5, 2).Shape();
  const TopoDS_Shape cone = BRepPrimAPI_MakeCone(3, 0, 6).Shape();
  return {
      {"drilled_box", bitten},
      {"crossing",
       BRepAlgoAPI_Fuse(cylinder({0, 0, -4}, {0, 0, 1}, 2, 8), cylinder({-4, 0, 0}, {1, 0, 0}, 1, 8)).Shape()},
      {"slanted",
       BRepAlgoAPI_Cut(cylinder({0, 0, 0}, {0, 0, 1}, 2, 8), cylinder({-9, 0, 9}, {1, 0, 0.3}, 4, 18)).Shape()},
      {"pole", BRepAlgoAPI_Cut(ball, cylinder({0.2, 0.1, 0}, {0, 0, 1}, 1, 9)).Shape()},
      {"octant", BRepAlgoAPI_Common(ball, BRepPrimAPI_MakeBox(gp_Pnt(0, 0, 0), 9, 9, 9).Shape()).Shape()},
      {"seam", BRepAlgoAPI_Cut(ball, cylinder({0, 0, 0}, {1, 0, 0}, 1, 9)).Shape()},
      {"torus", BRepAlgoAPI_Cut(torus, cylinder({7, 0, 0}, {1, 0, 0.1}, 0.8, 9)).Shape()},
      {"tube", BRepAlgoAPI_Cut(torus, cylinder({0, 5, -9}, {0, 0, 1}, 0.7, 18)).Shape()},
      {"cone", BRepAlgoAPI_Cut(cone, cylinder({-9, 0.5, 2}, {1, 0, 0}, 0.7, 18)).Shape()},
  };
}

/// The types of the entities in the directory of an IGES file.
std::set<int> entity_types(const std::string& path) {
  std::ifstream file(path);
  std::set<int> types;
  for (std::string line; std::getline(file, line);)
    if (line.size() > 72 && line[72] == 'D') types.insert(std::atoi(line.substr(0, 8).c_str()));
  return types;
}

TEST(TrimRegions, AreThoseOfOpenCascadeInEveryFormat) {
  const ScratchFolder folder;
  std::mt19937_64 random(1);
  for (const char* const extension : {".step", ".igs", ".solid.igs", ".brep"}) {
    TrimRegionsCounts counts;
    std::set<int> types;
    for (const auto& [name, shape] : solids()) {
      const std::string path = folder / (name + extension);
      write_cad(shape, path);
      if (path.ends_with("igs")) types.merge(entity_types(path));
      const Result<DescribedShape> file = load_cad(path);
      ASSERT_TRUE(file.ok()) << path << file.status().message();
      compare_all(file->shape, 2000, random, counts, name + extension);
    }
    print(extension, counts);
    EXPECT_EQ(counts.wrong, 0u) << extension;
    EXPECT_EQ(counts.unread, 0u) << extension;
    EXPECT_LE(counts.beside, counts.points / 500) << extension;
    EXPECT_GE(counts.trimmed, 20u) << extension;
    for (const int type : {186, 514, 510, 508, 504, 502})
      EXPECT_EQ(types.contains(type), std::string(extension) == ".solid.igs") << extension << type;
    for (const int type : {144, 142}) EXPECT_EQ(types.contains(type), std::string(extension) == ".igs") << type;
  }
}

TEST(TrimRegions, OfRealFacesAreThoseOfOpenCascade) {
  const std::vector<std::filesystem::path> files = real_cad_files();
  if (files.empty()) GTEST_SKIP() << "TESSERA_TEST_DATA is not set";
  std::mt19937_64 random(2);
  TrimRegionsCounts all;
  std::size_t read = 0;
  std::set<int> types;
  for (const std::filesystem::path& path : files) {
    const Result<DescribedShape> file = load_cad(path);
    if (!file) continue;
    TrimRegionsCounts counts;
    compare_all(file->shape, 300, random, counts, path.filename());
    if (counts.faces == 0) continue;
    ++read;
    if (path.extension() == ".igs" || path.extension() == ".iges") types.merge(entity_types(path));
    if (counts.wrong + counts.beside > 0) print(path.filename().c_str(), counts);
    all.faces += counts.faces, all.trimmed += counts.trimmed, all.points += counts.points, all.on += counts.on;
    all.beside += counts.beside, all.wrong += counts.wrong, all.unread += counts.unread;
  }
  print((std::to_string(read) + " files").c_str(), all);
  EXPECT_EQ(all.wrong, 0u);
  EXPECT_LE(all.beside, all.points / 500);
  for (const int type : {141, 143, 142, 144}) EXPECT_TRUE(types.contains(type)) << type;
}

}}  // namespace tessera::test
