// Shapes that have no model, or a part of one.

#include <gtest/gtest.h>
#include <opencascade/BRepBuilderAPI_MakeEdge.hxx>
#include <opencascade/BRepBuilderAPI_MakeFace.hxx>
#include <opencascade/BRepPrimAPI_MakeBox.hxx>
#include <opencascade/BRep_Builder.hxx>
#include <opencascade/Geom_CylindricalSurface.hxx>
#include <opencascade/Geom_Plane.hxx>
#include <opencascade/Poly_Triangulation.hxx>
#include <opencascade/TopoDS_Shell.hxx>

#include <cfenv>
#include <cmath>

#include "occt/map_checks.h"
#include "occt/occt_shapes.h"
#include "support/errors.h"
#include "tessera/occt.h"
#include "tessera/throw.h"

namespace tessera::test { namespace {

using opencascade::handle;

TopoDS_Shape unit_box() { return BRepPrimAPI_MakeBox(1, 1, 1).Shape(); }

/// A face that is one triangle, and has no surface.
TopoDS_Face triangle() {
  TColgp_Array1OfPnt points(1, 3);
  points(1) = gp_Pnt(0, 0, 0), points(2) = gp_Pnt(1, 0, 0), points(3) = gp_Pnt(0, 1, 0);
  Poly_Array1OfTriangle triangles(1, 1);
  triangles(1) = Poly_Triangle(1, 2, 3);
  TopoDS_Face face;
  BRep_Builder().MakeFace(face, new Poly_Triangulation(points, triangles));
  return face;
}

TopoDS_Face bare_face() {
  TopoDS_Face face;
  BRep_Builder().MakeFace(face);
  return face;
}

TopoDS_Face infinite_plane() { return BRepBuilderAPI_MakeFace(gp_Pln()).Face(); }

TEST(BadShapes, WithoutFacesAreRefused) {
  expect_refused(model_from(TopoDS_Shape()), StatusCode::invalid_argument, -1, "the shape is null");
  expect_refused(model_from(compound_of({})), StatusCode::invalid_argument, -1, "has no faces");
  expect_refused(model_from(BRepBuilderAPI_MakeEdge(gp_Pnt(), gp_Pnt(1, 0, 0)).Edge()), StatusCode::invalid_argument,
                 -1, "has no faces");
  TopoDS_Shell shell;
  BRep_Builder().MakeShell(shell);
  expect_refused(model_from(shell), StatusCode::invalid_argument, -1, "has no faces");
}

TEST(BadShapes, FacesWithoutSurfaceOrBoundsAreNamed) {
  expect_refused(model_from(triangle()), StatusCode::unsupported, -1,
                 "no surface can be read: face 0 is left out: it has no surface, it is a mesh of 1 triangle");
  expect_refused(model_from(bare_face()), StatusCode::unsupported, -1, "it has no surface");
  expect_refused(model_from(infinite_plane()), StatusCode::unsupported, -1, "it has no bounds");
  const handle<Geom_Surface> cylinder = new Geom_CylindricalSurface(gp_Ax3(), 2);
  expect_refused(model_from(BRepBuilderAPI_MakeFace(cylinder, 1e-7).Face()), StatusCode::unsupported, -1,
                 "it has no bounds");
}

// The rest of the shape is there, with all maps.
TEST(BadShapes, AFaceThatIsLeftOutLeavesTheOthers) {
  const TopoDS_Face mesh = triangle(), plane = infinite_plane();
  const TopoDS_Shape moved = compound_of({mesh, unit_box()}).Moved(shift(3, 0, 0));
  const TopoDS_Compound shape = compound_of({moved, plane, drilled_box(), bare_face()});
  const OcctModel all = value_or_throw(model_from(shape));
  EXPECT_EQ(all.model.surfaces.size(), faces_in(shape).size() - 3);
  ASSERT_EQ(all.left_out.size(), 3u);
  EXPECT_TRUE(all.left_out[0].IsEqual(mesh.Moved(shift(3, 0, 0))) || all.left_out[0].IsPartner(mesh));
  EXPECT_EQ(all.left_out[0].Location().Transformation().TranslationPart().X(), 3);
  EXPECT_TRUE(all.left_out[1].IsEqual(plane));
  ASSERT_EQ(all.model.warnings.size(), 3u);
  EXPECT_EQ(all.model.warnings[0], "face 0 is left out: it has no surface, it is a mesh of 1 triangle");
  EXPECT_EQ(all.model.warnings[1], "face 7 is left out: it has no bounds");
  expect_mapped(all, shape, "what is left");
}

TEST(BadShapes, NumbersThatAreNoneAreRefused) {
  for (const double bad : {not_a_number, infinity}) {
    const handle<Geom_Surface> plane = new Geom_Plane(gp_Pnt(bad, 0, 0), gp_Dir(0, 0, 1));
    TopoDS_Face face;
    BRep_Builder().MakeFace(face, plane, 1e-7);
    EXPECT_FALSE(model_from(face).ok());
    const Result<OcctModel> part = model_from(compound_of({face, unit_box()}));
    ASSERT_TRUE(part.ok());
    EXPECT_EQ(part->left_out.size(), 1u);
  }
}

// Forty levels of compounds that hold the same one twice have more boxes than any memory.
TEST(BadShapes, PartsAtTooManyPlacesAreRefused) {
  TopoDS_Shape shape = unit_box();
  for (int level = 0; level < 40; ++level)
    shape = compound_of({shape, shape.Moved(shift(1 << (level % 20), level, 0))});
  expect_refused(model_from(shape), StatusCode::unsupported, -1, "counted at each of their places");
}

TEST(BadShapes, CancelledCallsSaySo) {
  const std::atomic<bool> cancel{true};
  expect_refused(model_from(drilled_box(), {.cancel = &cancel}), StatusCode::cancelled, -1, "");
}

TEST(BadShapes, ProgressRisesToOne) {
  std::vector<double> shares;
  value_or_throw(model_from(drilled_box(), {.progress = [&](double share) { shares.push_back(share); }}));
  ASSERT_FALSE(shares.empty());
  EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
  EXPECT_EQ(shares.back(), 1);
}

// Programs of OpenCASCADE may let divisions by zero trap; the call ends with the settings that it found.
TEST(BadShapes, FloatingPointExceptionsDoNotTrap) {
#ifdef __GLIBC__
  const TopoDS_Shape shape = compound_of({drilled_box(), infinite_plane()});
  std::fenv_t before;
  std::fegetenv(&before);
  feenableexcept(FE_DIVBYZERO | FE_INVALID | FE_OVERFLOW);
  const int trapped = fegetexcept();
  const Result<OcctModel> all = model_from(shape);
  const int after = fegetexcept();
  std::fesetenv(&before);
  EXPECT_TRUE(all.ok());
  EXPECT_EQ(after, trapped);
#else
  GTEST_SKIP() << "this C library does not let floating-point exceptions trap";
#endif
}

}}  // namespace tessera::test
