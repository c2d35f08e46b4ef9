// Trimming loops exist if a face is less than its rectangle, are closed, and run along the edges.

#include <gtest/gtest.h>
#include <opencascade/BRepAlgoAPI_Cut.hxx>
#include <opencascade/BRepPrimAPI_MakeBox.hxx>
#include <opencascade/BRepPrimAPI_MakeCylinder.hxx>
#include <opencascade/BRepPrimAPI_MakeSphere.hxx>
#include <opencascade/BRepPrimAPI_MakeTorus.hxx>

#include <cmath>
#include <numbers>

#include "io_occt/cad_shapes.h"
#include "support/scratch_folder.h"
#include "tessera/cad.h"

namespace tessera::test { namespace {

Vec3 start_of(const Curve& curve) { return evaluate_jet(curve, curve.domain().from).position; }
Vec3 end_of(const Curve& curve) { return evaluate_jet(curve, curve.domain().to).position; }

/// The area inside the loops, from fine polygons; holes count as negative.
double area(const std::vector<TrimLoop>& loops) {
  double sum = 0;
  for (const TrimLoop& loop : loops) {
    double twice = 0;
    for (const Curve& curve : loop.curves) {
      const int steps = 2000;
      Vec3 before = start_of(curve);
      for (int k = 1; k <= steps; ++k) {
        const Interval& d = curve.domain();
        const Vec3 now = evaluate_jet(curve, d.from + (d.to - d.from) * k / steps).position;
        twice += cross(before, now).z;
        before = now;
      }
    }
    sum += (loop.hole ? -0.5 : 0.5) * std::abs(twice);
  }
  return sum;
}

/// A box with a round hole and a bite out of a corner, in every format.
std::vector<Model> drilled_box() {
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(gp_Pnt(0, 0, 0), 10, 8, 3).Shape();
  const TopoDS_Shape drill = BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(4, 4, -1), gp_Dir(0, 0, 1)), 1.5, 9).Shape();
  const TopoDS_Shape bite = BRepPrimAPI_MakeSphere(gp_Pnt(10, 8, 3), 2).Shape();
  const TopoDS_Shape part = BRepAlgoAPI_Cut(BRepAlgoAPI_Cut(box, drill).Shape(), bite).Shape();
  const ScratchFolder folder;
  std::vector<Model> models;
  for (const char* const name : {"part.step", "part.igs", "part.brep"}) {
    write_cad(part, folder / name);
    Result<Model> model = read_by_opencascade(folder / name);
    EXPECT_TRUE(model.ok()) << model.status().message();
    if (model) models.push_back(*std::move(model));
  }
  return models;
}

TEST(Trims, AreWhereAFaceIsLessThanItsRectangle) {
  const std::vector<Model> models = drilled_box();
  ASSERT_EQ(models.size(), 3u);
  constexpr double pi = std::numbers::pi;
  for (const Model& model : models) {
    ASSERT_EQ(model.surfaces.size(), 8u);
    std::vector<double> areas;
    std::size_t holes = 0;
    for (const ModelSurface& surface : model.surfaces) {
      const BSplineSurface& s = std::get<BSplineSurface>(surface.surface);
      if (s.is_rational()) continue;  // planes, whose parameters are lengths
      const Domain& d = s.domain();
      const double scale = length(evaluate_jet(s, d.u0, d.v0).du) * length(evaluate_jet(s, d.u0, d.v0).dv);
      areas.push_back(scale * (surface.trims->empty() ? (d.u1 - d.u0) * (d.v1 - d.v0) : area(surface.trims)));
      for (const TrimLoop& loop : *surface.trims) holes += loop.hole;
    }
    std::sort(areas.begin(), areas.end());
    ASSERT_EQ(areas.size(), 6u);
    const double drill = 2.25 * pi, bite = pi;  // the bite takes a quarter of a disc of radius 2
    const std::vector<double> expected{24 - bite, 24, 30 - bite, 30, 80 - drill - bite, 80 - drill};
    for (std::size_t k = 0; k < 6; ++k) EXPECT_NEAR(areas[k], expected[k], 1e-3) << k;
    EXPECT_EQ(holes, 2u);
    EXPECT_TRUE(model.warnings.empty());
  }
}

TEST(Trims, LoopsFollowCurvesThroughRationalParameters) {
  // Holes through a torus: their edges are not isocurves of its parameters.
  const TopoDS_Shape torus = BRepPrimAPI_MakeTorus(5, 2).Shape();
  const TopoDS_Shape drill = BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(0, 5, -9), gp_Dir(0, 0, 1)), 0.7, 18).Shape();
  const ScratchFolder folder;
  write_cad(BRepAlgoAPI_Cut(torus, drill).Shape(), folder / "torus.step");
  const Result<Model> model = read_by_opencascade(folder / "torus.step");
  ASSERT_TRUE(model.ok()) << model.status().message();
  std::size_t checked = 0;
  for (const ModelSurface& surface : model->surfaces) {
    const BSplineSurface& s = std::get<BSplineSurface>(surface.surface);
    for (const TrimLoop& loop : *surface.trims) {
      if (!loop.hole) continue;
      for (const Curve& curve : loop.curves)
        for (int k = 0; k <= 50; ++k) {
          const Interval& d = curve.domain();
          const Vec3 uv = evaluate_jet(curve, d.from + (d.to - d.from) * k / 50).position;
          const Vec3 p = surface.placement->point(evaluate_jet(s, uv.x, uv.y).position);
          EXPECT_NEAR(std::hypot(p.x, p.y - 5), 0.7, 1e-4);  // OpenCASCADE's curves are that good
          EXPECT_NEAR(std::hypot(std::hypot(p.x, p.y) - 5, p.z), 2, 1e-12);
          ++checked;
        }
    }
  }
  EXPECT_GE(checked, 102u);
}

/// The distance in space of two points of the parameters.
double gap(const ModelSurface& surface, const Vec3& a, const Vec3& b) {
  const BSplineSurface& s = std::get<BSplineSurface>(surface.surface);
  return length(evaluate_jet(s, a.x, a.y).position - evaluate_jet(s, b.x, b.y).position);
}

TEST(Trims, LoopsOfRealFilesClose) {
  const std::vector<std::filesystem::path> files = real_cad_files();
  if (files.empty()) GTEST_SKIP() << "TESSERA_TEST_DATA is not set";
  std::size_t loops = 0, curves = 0;
  double worst = 0;
  for (const std::filesystem::path& path : files) {
    const Result<Model> model = read_by_opencascade(path);
    if (!model) continue;
    for (const ModelSurface& surface : model->surfaces) {
      const BSplineSurface& s = std::get<BSplineSurface>(surface.surface);
      Box3 points;
      for (const Vec3& p : s.points()) points.extend(p);
      for (const TrimLoop& loop : *surface.trims) {
        ++loops;
        for (std::size_t k = 0; k < loop.curves.size(); ++k) {
          const double off = gap(surface, end_of(loop.curves[k]), start_of(loop.curves[(k + 1) % loop.curves.size()]));
          worst = std::max(worst, off / points.diagonal());
          EXPECT_LT(off, 1e-3 * points.diagonal()) << path << ' ' << *surface.name << " curve " << k;
          ++curves;
        }
      }
    }
  }
  std::printf("%zu loops of %zu curves; gaps of at most %.2g of their surface\n", loops, curves, worst);
  EXPECT_GT(loops, 200u);
}

}}  // namespace tessera::test
