// Surfaces of faces: points equal OpenCASCADE's own at the same parameters.

#include <gtest/gtest.h>
#include <opencascade/BRepBuilderAPI_MakeFace.hxx>
#include <opencascade/BRepPrimAPI_MakeBox.hxx>
#include <opencascade/BRepPrimAPI_MakeCone.hxx>
#include <opencascade/BRepPrimAPI_MakeCylinder.hxx>
#include <opencascade/BRepPrimAPI_MakeSphere.hxx>
#include <opencascade/BRepPrimAPI_MakeTorus.hxx>
#include <opencascade/BRep_Tool.hxx>
#include <opencascade/Geom_BSplineCurve.hxx>
#include <opencascade/Geom_BSplineSurface.hxx>
#include <opencascade/Geom_BezierSurface.hxx>
#include <opencascade/Geom_Ellipse.hxx>
#include <opencascade/Geom_Hyperbola.hxx>
#include <opencascade/Geom_OffsetSurface.hxx>
#include <opencascade/Geom_Parabola.hxx>
#include <opencascade/Geom_SphericalSurface.hxx>
#include <opencascade/Geom_SurfaceOfLinearExtrusion.hxx>
#include <opencascade/Geom_SurfaceOfRevolution.hxx>
#include <opencascade/Geom_ToroidalSurface.hxx>
#include <opencascade/TColgp_Array1OfPnt.hxx>
#include <opencascade/TColgp_Array2OfPnt.hxx>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numbers>
#include <random>

#include "io_occt/cad_shapes.h"
#include "occt/face_loops.h"
#include "occt/face_surface.h"
#include "occt/shape_model.h"
#include "occt/spline_line.h"
#include "support/scratch_folder.h"
#include "tessera/cad.h"

namespace tessera::test { namespace {

using opencascade::handle;
/// The largest distance at `count` random parameters, by the size of the points.
double distance(const handle<Geom_Surface>& surface, const FaceSurface& ours, const Domain& box, int count) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  double largest = 0, size = 0;
  for (int k = 0; k < count; ++k) {
    const double u = k == 0 ? box.u0 : box.u_at(unit(random)), v = k < 2 ? box.v1 : box.v_at(unit(random));
    const Vec3 theirs = vec3(surface->Value(u, v).XYZ());
    const std::array<double, 2> uv = ours.parameters(u, v);
    largest = std::max(largest, length(theirs - evaluate_jet(ours.surface, uv[0], uv[1]).position));
    size = std::max(size, length(theirs));
  }
  return largest / size;
}

void expect_exact(const handle<Geom_Surface>& surface, const Domain& box) {
  const Result<FaceSurface> ours = face_surface(surface, box);
  ASSERT_TRUE(ours.ok()) << ours.status().message();
  EXPECT_EQ(ours->fit_error, 0);
  EXPECT_LT(distance(surface, *ours, box, 200), 1e-14) << surface->DynamicType()->Name();
  // Knots at periods may differ from the ends by rounding, and are taken for the ends.
  EXPECT_NEAR(ours->surface.domain().u0, box.u0, 1e-12 * (box.u1 - box.u0));
  EXPECT_NEAR(ours->surface.domain().v1, box.v1, 1e-12 * (box.v1 - box.v0));
}

const gp_Ax3 tilted(gp_Pnt(3, -1, 2), gp_Dir(1, 2, 3), gp_Dir(1, 0, 0));

gp_Ax3 left_handed() {
  gp_Ax3 axes = tilted;
  axes.YReverse();
  return axes;
}

TEST(FaceSurface, AnalyticSurfacesAreExact) {
  for (const gp_Ax3& axes : {tilted, left_handed()}) {
    expect_exact(new Geom_SphericalSurface(axes, 2),
                 {0, 2 * std::numbers::pi, -std::numbers::pi / 2, std::numbers::pi / 2});
    expect_exact(new Geom_SphericalSurface(axes, 2), {-1, 0.3, 0.1, 1.2});
    expect_exact(new Geom_ToroidalSurface(axes, 5, 2), {1, 1 + 2 * std::numbers::pi, -3, 3});
    expect_exact(new Geom_ToroidalSurface(axes, 5, 2), {6, 7, 0, 2 * std::numbers::pi});
  }
  const gp_Ax2 axes = tilted.Ax2();
  for (const TopoDS_Shape& solid :
       {BRepPrimAPI_MakeCylinder(axes, 2, 5).Shape(), BRepPrimAPI_MakeCone(axes, 2, 0, 5).Shape(),
        BRepPrimAPI_MakeCone(axes, 0.5, 3, 2, 1.0).Shape(), BRepPrimAPI_MakeBox(axes, 1, 2, 3).Shape()}) {
    for (const TopoDS_Face& face : faces_of(solid)) {
      const Result<FaceBox> box = face_box(face_border(face));
      ASSERT_TRUE(box.ok()) << box.status().message();
      expect_exact(BRep_Tool::Surface(face), box->domain);
    }
  }
}

TEST(FaceSurface, PolesAndApexesAreCollapsed) {
  const Result<FaceSurface> sphere = face_surface(
      new Geom_SphericalSurface(tilted, 2), {0, 2 * std::numbers::pi, -std::numbers::pi / 2, std::numbers::pi / 2});
  ASSERT_TRUE(sphere.ok());
  const BSplineSurface& s = sphere->surface;
  for (std::size_t i = 0; i < s.count_u(); ++i) {
    EXPECT_EQ(s.point(i, 0), s.point(0, 0));
    EXPECT_EQ(s.point(i, s.count_v() - 1), s.point(0, s.count_v() - 1));
  }
  for (std::size_t j = 0; j < s.count_v(); ++j) EXPECT_EQ(s.point(0, j), s.point(s.count_u() - 1, j)) << "open seam";
}

handle<Geom_Curve> wave(bool rational, bool periodic) {
  const int count = 7;
  TColgp_Array1OfPnt poles(1, count);
  TColStd_Array1OfReal weights(1, count);
  for (int k = 1; k <= count; ++k) {
    poles(k) = gp_Pnt(3 + std::cos(k), std::sin(k), 0.3 * std::cos(2.0 * k));
    weights(k) = rational ? 1 + 0.1 * k : 1;
  }
  TColStd_Array1OfReal knots(1, periodic ? 6 : 5);
  TColStd_Array1OfInteger multiplicities(1, knots.Length());
  for (int k = 1; k <= knots.Length(); ++k) {
    knots(k) = 0.1 * k * k - 3;
    multiplicities(k) = 1;
  }
  if (periodic) {
    multiplicities(1) = multiplicities(6) = multiplicities(3) = 2;
  } else {
    multiplicities(1) = multiplicities(5) = 4;
  }
  return new Geom_BSplineCurve(poles, weights, knots, multiplicities, 3, periodic);
}

TEST(FaceSurface, SweptSurfacesAreExact) {
  for (const bool rational : {false, true})
    for (const bool periodic : {false, true}) {
      const handle<Geom_Curve> curve = wave(rational, periodic);
      const double a = curve->FirstParameter(), b = curve->LastParameter();
      expect_exact(new Geom_SurfaceOfLinearExtrusion(curve, gp_Dir(1, 1, 5)), {a, b, -2, 7});
      expect_exact(new Geom_SurfaceOfRevolution(curve, tilted.Axis()), {1, 4, a, b});
      expect_exact(new Geom_SurfaceOfLinearExtrusion(curve, gp_Dir(1, 1, 5)), {a + 0.2, b - 0.3, -2, 7});
      // OrthonormalBasis the seam, and a turn away.
      if (periodic) expect_exact(new Geom_SurfaceOfLinearExtrusion(curve, gp_Dir(1, 1, 5)), {a + 0.6, b + 0.5, 0, 1});
      if (periodic) expect_exact(new Geom_SurfaceOfLinearExtrusion(curve, gp_Dir(1, 1, 5)), {a - 9, b - 10, 0, 1});
    }
  const gp_Ax2 axes = tilted.Ax2();
  expect_exact(new Geom_SurfaceOfLinearExtrusion(new Geom_Ellipse(axes, 3, 1), gp_Dir(1, 1, 5)), {2, 6, 0, 1});
  expect_exact(new Geom_SurfaceOfLinearExtrusion(new Geom_Parabola(axes, 0.7), gp_Dir(1, 1, 5)), {-2, 3, 0, 1});
  expect_exact(new Geom_SurfaceOfRevolution(new Geom_Ellipse(axes, 3, 1), gp_Ax1(gp_Pnt(9, 9, 9), gp_Dir(0, 1, 1))),
               {0, 2 * std::numbers::pi, 0, 2 * std::numbers::pi});
}

/// A torus of poles, periodic both ways.
handle<Geom_BSplineSurface> periodic_surface(int count_u, int count_v, int degree_u, int degree_v) {
  TColgp_Array2OfPnt poles(1, count_u, 1, count_v);
  for (int i = 1; i <= count_u; ++i)
    for (int j = 1; j <= count_v; ++j) {
      const double a = 2 * std::numbers::pi * i / count_u, b = 2 * std::numbers::pi * j / count_v;
      poles(i, j) = gp_Pnt((4 + std::cos(b)) * std::cos(a), (4 + std::cos(b)) * std::sin(a), std::sin(b) + 0.1 * i);
    }
  const auto knots = [](int count) {
    TColStd_Array1OfReal all(1, count + 1);
    for (int k = 1; k <= count + 1; ++k) all(k) = 0.7 * k + 0.1 * (k % 2) * (count % 2 == 0);
    return all;
  };
  const auto ones = [](int count) {
    TColStd_Array1OfInteger all(1, count + 1);
    all.Init(1);
    return all;
  };
  return new Geom_BSplineSurface(poles, knots(count_u), knots(count_v), ones(count_u), ones(count_v), degree_u,
                                 degree_v, true, true);
}

TEST(FaceSurface, PeriodicSplinesKeepTheirPolesAndParameters) {
  const handle<Geom_BSplineSurface> surface = periodic_surface(8, 5, 3, 2);
  double u0, u1, v0, v1;
  surface->Bounds(u0, u1, v0, v1);
  expect_exact(surface, {u0, u1, v0, v1});
  expect_exact(surface, {u0 + 1, u1 + 0.5, v0 - 2, v1 - 2.5});
  expect_exact(surface, {u0 + 3 * (u1 - u0), u1 + 3 * (u1 - u0), v0, v1});
  const Result<FaceSurface> ours = face_surface(surface, {u0, u1, v0, v1});
  ASSERT_TRUE(ours.ok());
  EXPECT_EQ(ours->surface.count_u(), 8u + 3u);
  EXPECT_EQ(ours->surface.point(8, 0), ours->surface.point(0, 0));
}

/// The narrowest patch along either direction, as a part of the surface's range.
double narrowest_patch(const BSplineSurface& surface) {
  const PatchGrid grid = *to_bezier(surface);
  double narrowest = 1;
  for (const auto breaks : {grid.breaks_u(), grid.breaks_v()})
    for (std::size_t k = 1; k < breaks.size(); ++k)
      narrowest = std::min(narrowest, (breaks[k] - breaks[k - 1]) / (breaks.back() - breaks.front()));
  return narrowest;
}

TEST(FaceBox, EndsThatAreKnotsButForRoundingAreKnots) {
  const handle<Geom_BSplineSurface> surface = periodic_surface(8, 5, 3, 2);
  double u0, u1, v0, v1;
  surface->Bounds(u0, u1, v0, v1);
  const TColStd_Array1OfReal &knots_u = surface->UKnots(), &knots_v = surface->VKnots();
  for (const double off : {0.0, 1e-15, -1e-15, 1e-12, -1e-12, 1e-10})
    for (const double turn : {0.0, 1.0, -2.0}) {
      const double period = turn * (u1 - u0);
      const Domain box{knots_u(2) + period + off, knots_u(6) + period - off, knots_v(2) - off, knots_v(4) + off};
      const TopoDS_Face face = BRepBuilderAPI_MakeFace(surface, box.u0, box.u1, box.v0, box.v1, 1e-7);
      const Result<FaceBox> found = face_box(face_border(face));
      ASSERT_TRUE(found.ok()) << found.status().message();
      const Result<FaceSurface> ours = face_surface(surface, found->domain);
      ASSERT_TRUE(ours.ok()) << ours.status().message();
      EXPECT_GT(narrowest_patch(ours->surface), 0.1) << off << ' ' << turn;
      EXPECT_NEAR(ours->surface.domain().v0, knots_v(2), 1e-15);
    }
}

/// The narrowest patch at an end that is no knot, as a part of the surface's range.
double narrowest_end(const BSplineSurface& surface) {
  const PatchGrid grid = *to_bezier(surface);
  double narrowest = 1;
  const auto look = [&](std::span<const double> breaks, std::span<const double> knots) {
    const double range = breaks.back() - breaks.front();
    const auto is_knot = [&](double end) { return std::ranges::find(knots, end) != knots.end(); };
    if (!is_knot(breaks.front())) narrowest = std::min(narrowest, (breaks[1] - breaks[0]) / range);
    if (!is_knot(breaks.back())) narrowest = std::min(narrowest, (breaks.back() - breaks[breaks.size() - 2]) / range);
  };
  look(grid.breaks_u(), surface.knots_u());
  look(grid.breaks_v(), surface.knots_v());
  return narrowest;
}

TEST(FaceBox, NoRealFaceEndsInSlivers) {
  const std::vector<std::filesystem::path> files = real_cad_files();
  if (files.empty()) GTEST_SKIP() << "TESSERA_TEST_DATA is not set";
  for (const std::filesystem::path& path : files) {
    const Result<Model> model = read_by_opencascade(path);
    for (std::size_t k = 0; model && k < model->surfaces.size(); ++k)
      EXPECT_GT(narrowest_end(std::get<BSplineSurface>(model->surfaces[k].surface)), 1e-5) << path << ", face " << k;
  }
}

TEST(FaceSurface, BezierSurfacesKeepTheirPoles) {
  TColgp_Array2OfPnt poles(1, 3, 1, 4);
  TColStd_Array2OfReal weights(1, 3, 1, 4);
  for (int i = 1; i <= 3; ++i)
    for (int j = 1; j <= 4; ++j) {
      poles(i, j) = gp_Pnt(i, j, std::sin(i * j));
      weights(i, j) = 1 + 0.1 * i * j;
    }
  expect_exact(new Geom_BezierSurface(poles, weights), {0, 1, 0, 1});
  expect_exact(new Geom_BezierSurface(poles), {0.25, 1, 0, 0.5});
}

TEST(FaceSurface, WhatHasNoExactFormIsFitted) {
  const handle<Geom_Surface> base = new Geom_SurfaceOfLinearExtrusion(wave(false, false), gp_Dir(0, 0, 1));
  double u0, u1, v0, v1;
  base->Bounds(u0, u1, v0, v1);
  const gp_Ax2 axes = tilted.Ax2();
  for (const handle<Geom_Surface>& surface :
       {handle<Geom_Surface>(new Geom_OffsetSurface(base, 0.05)),
        handle<Geom_Surface>(new Geom_SurfaceOfLinearExtrusion(new Geom_Hyperbola(axes, 2, 1), gp_Dir(1, 1, 5)))}) {
    const Domain box{u0, u1, 0, 2};
    const Result<FaceSurface> ours = face_surface(surface, box);
    ASSERT_TRUE(ours.ok()) << ours.status().message();
    EXPECT_GT(ours->fit_error, 0);
    EXPECT_LT(distance(surface, *ours, box, 300), 3e-6);
  }
  // An offset sphere is a sphere.
  expect_exact(new Geom_OffsetSurface(new Geom_SphericalSurface(tilted, 2), 0.5), {0, 1, 0, 1});
}

TEST(FaceSurface, RealFacesAreWhereOpenCascadeHasThem) {
  const std::vector<std::filesystem::path> files = real_cad_files();
  if (files.empty()) GTEST_SKIP() << "TESSERA_TEST_DATA is not set";
  std::size_t exact = 0, fitted = 0;
  double worst = 0;
  for (const std::filesystem::path& path : files) {
    const Result<DescribedShape> file = load_cad(path.string());
    ASSERT_TRUE(file.ok()) << file.status().message();
    for (const TopoDS_Face& face : faces_of(file->shape)) {
      TopLoc_Location place;
      const handle<Geom_Surface> surface = BRep_Tool::Surface(face, place);
      const Result<FaceBox> box = face_box(face_border(face));
      ASSERT_TRUE(box.ok()) << path << box.status().message();
      const Result<FaceSurface> ours = face_surface(surface, box->domain);
      ASSERT_TRUE(ours.ok()) << path << ours.status().message();
      const double off = distance(surface, *ours, box->domain, 100);
      (ours->fit_error > 0 ? fitted : exact) += 1;
      if (ours->fit_error == 0) worst = std::max(worst, off);
      EXPECT_LT(off, ours->fit_error > 0 ? 1e-5 : 1e-12) << path << ' ' << surface->DynamicType()->Name();
    }
  }
  std::printf("%zu faces exact, off by at most %.2g of their size; %zu fitted\n", exact, worst, fitted);
  EXPECT_GT(exact, 400u);
}

/// For a solid about `inside`, that every face's normal points away from it.
void expect_normals_outwards(const Model& model, const Vec3& inside) {
  for (const ModelSurface& surface : model.surfaces) {
    const BSplineSurface& s = std::get<BSplineSurface>(surface.surface);
    const Domain& d = s.domain();
    const SurfaceJet jet = evaluate_jet(s, d.u_at(0.4), d.v_at(0.6));
    const Vec3 normal = surface.placement->vector(cross(jet.du, jet.dv));
    EXPECT_GT(dot(normal, surface.placement->point(jet.position) - inside), 0);
  }
}

TEST(ReadCad, PrimitivesComeBackFromEveryFormat) {
  const ScratchFolder folder;
  const gp_Ax2 axes = tilted.Ax2();
  const Vec3 origin = vec3(axes.Location().XYZ()), z = vec3(axes.Direction().XYZ());
  for (const char* const name : {"sphere.step", "sphere.igs", "sphere.brep", "sphere.binary.brep"}) {
    write_cad(BRepPrimAPI_MakeSphere(axes, 2).Shape(), folder / name);
    const Result<Model> model = read_by_opencascade(folder / name);
    ASSERT_TRUE(model.ok()) << model.status().message();
    EXPECT_EQ(model->name.find("sphere"), 0u);
    EXPECT_TRUE(model->warnings.empty()) << model->warnings[0];
    ASSERT_EQ(model->surfaces.size(), 1u);
    const ModelSurface& surface = model->surfaces[0];
    EXPECT_TRUE(surface.trims->empty());
    const BSplineSurface& s = std::get<BSplineSurface>(surface.surface);
    for (const double u : {0.0, 0.3, 0.77})
      for (const double v : {0.1, 0.5, 1.0}) {
        const Vec3 p = evaluate_jet(s, s.domain().u_at(u), s.domain().v_at(v)).position;
        EXPECT_NEAR(length(surface.placement->point(p) - origin), 2, 1e-13) << name;
      }
    expect_normals_outwards(*model, origin);
  }
  for (const char* const name : {"cylinder.stp", "cylinder.IGES", "cylinder.brp"}) {
    write_cad(BRepPrimAPI_MakeCylinder(axes, 2, 5).Shape(), folder / name);
    const Result<Model> model = read_by_opencascade(folder / name);
    ASSERT_TRUE(model.ok()) << model.status().message();
    ASSERT_EQ(model->surfaces.size(), 3u);
    expect_normals_outwards(*model, origin + 2.5 * z);
    EXPECT_TRUE(model->warnings.empty());
    const auto is_trimmed = [](const ModelSurface& surface) { return !surface.trims->empty(); };
    EXPECT_EQ(std::count_if(model->surfaces.begin(), model->surfaces.end(), is_trimmed), 2);
  }
}

TEST(ReadCad, IgesExponentsAreWrittenWithEOrD) {
  TColgp_Array2OfPnt poles(1, 3, 1, 2);
  for (int i = 1; i <= 3; ++i)
    for (int j = 1; j <= 2; ++j) poles(i, j) = gp_Pnt(1.25e-5 * i, 3e-5 * j, 1.5e7 * i * j);
  const ScratchFolder folder;
  write_cad(BRepBuilderAPI_MakeFace(new Geom_BezierSurface(poles), 1e-9).Shape(), folder / "e.igs");
  std::string text = content_of(folder / "e.igs");
  std::size_t changed = 0;
  for (std::size_t line = 0; line + 81 <= text.size(); line += 81)  // the first 64 columns of parameter lines
    for (std::size_t k = line; text[line + 72] == 'P' && k + 1 < line + 64; ++k)
      if (text[k] == 'E' && (text[k + 1] == '-' || text[k + 1] == '+' || std::isdigit(text[k + 1]))) {
        text[k] = 'D';
        ++changed;
      }
  ASSERT_GE(changed, 6u) << text;
  const Result<Model> with_e = read_by_opencascade(folder / "e.igs"),
                      with_d = read_by_opencascade(folder.file("d.igs", text));
  ASSERT_TRUE(with_e.ok()) << with_e.status().message();
  ASSERT_TRUE(with_d.ok()) << with_d.status().message();
  const auto points = [](const Model& model) {
    return std::get<BSplineSurface>(model.surfaces.at(0).surface).points();
  };
  EXPECT_NEAR(points(*with_e).back().x, 3.75e-5, 1e-18);
  EXPECT_TRUE(std::ranges::equal(points(*with_e), points(*with_d)));
}

TEST(ReadCad, IsWhatThisProcessMakesOfTheFile) {
  const std::vector<std::filesystem::path> files = real_cad_files();
  if (files.empty()) GTEST_SKIP() << "TESSERA_TEST_DATA is not set";
  for (const std::filesystem::path& path : files) {
    const Result<Model> read = read_by_opencascade(path);
    if (read.status().code() == StatusCode::internal) continue;  // OpenCASCADE crashes, and would end this process
    const Result<DescribedShape> file = load_cad(path.string());
    const Result<OcctModel> made = file ? model_of(*file, path.string()) : Result<OcctModel>(file.status());
    const Result<Model> here = made ? Result<Model>(made->model) : made.status();
    ASSERT_EQ(here.ok(), read.ok());
    EXPECT_EQ(here.status().message(), read.status().message());
    if (!read) continue;
    EXPECT_EQ(here->warnings, read->warnings);
    ASSERT_EQ(here->surfaces.size(), read->surfaces.size());
    for (std::size_t k = 0; k < read->surfaces.size(); ++k) {
      const BSplineSurface &a = std::get<BSplineSurface>(here->surfaces[k].surface),
                           &b = std::get<BSplineSurface>(read->surfaces[k].surface);
      EXPECT_TRUE(std::ranges::equal(a.points(), b.points()) && a.domain() == b.domain()) << path;
      EXPECT_TRUE(here->surfaces[k].placement == read->surfaces[k].placement);
    }
  }
}

}}  // namespace tessera::test
