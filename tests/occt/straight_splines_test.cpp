// Spline surfaces that run straight along a parameter take as few triangles as such surfaces do, at their parameters.

#include <gtest/gtest.h>

#include <opencascade/BRepBuilderAPI_MakeFace.hxx>
#include <opencascade/BRep_Tool.hxx>
#include <opencascade/Geom_BSplineSurface.hxx>
#include <opencascade/Poly_Triangulation.hxx>
#include <opencascade/TColStd_Array1OfInteger.hxx>
#include <opencascade/TColStd_Array1OfReal.hxx>
#include <opencascade/TColgp_Array2OfPnt.hxx>
#include <opencascade/TopoDS_Face.hxx>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <vector>

#include "occt/poly_checks.h"
#include "support/synthetic_sets.h"
#include "tessera/occt_mesh.h"

namespace tessera::test { namespace {

using opencascade::handle;

struct UnevenKnots {
  std::vector<double> at;  ///< of multiplicity 1, but at the ends
  int degree;

  int poles() const { return static_cast<int>(at.size()) + degree - 1; }
  double flat(int k) const { return at[static_cast<std::size_t>(std::clamp(k - degree, 0, int(at.size()) - 1))]; }
  double greville(int pole) const {
    double sum = 0;
    for (int j = 1; j <= degree; ++j) sum += flat(pole + j);
    return sum / degree;
  }
  TColStd_Array1OfReal values() const {
    TColStd_Array1OfReal out(1, int(at.size()));
    for (int k = 1; k <= out.Upper(); ++k) out(k) = at[static_cast<std::size_t>(k - 1)];
    return out;
  }
  TColStd_Array1OfInteger multiplicities() const {
    TColStd_Array1OfInteger out(1, int(at.size()));
    out.Init(1);
    out(1) = out(out.Upper()) = degree + 1;
    return out;
  }
};

UnevenKnots knots(int spans, int degree) {
  UnevenKnots out{{}, degree};
  for (int k = 0; k <= spans; ++k) out.at.push_back(k + 0.3 * std::sin(3.0 * k));
  return out;
}

/// A face whose control points are point(u, v) at the Greville abscissae.
TopoDS_Face face_of(const UnevenKnots& u, const UnevenKnots& v, const std::function<gp_Pnt(double, double)>& point) {
  TColgp_Array2OfPnt poles(1, u.poles(), 1, v.poles());
  for (int i = 0; i < u.poles(); ++i)
    for (int j = 0; j < v.poles(); ++j) poles(i + 1, j + 1) = point(u.greville(i), v.greville(j));
  const handle<Geom_BSplineSurface> surface = new Geom_BSplineSurface(poles, u.values(), v.values(), u.multiplicities(),
                                                                      v.multiplicities(), u.degree, v.degree);
  return BRepBuilderAPI_MakeFace(surface, 1e-7).Face();
}

/// Triangulates a face; the largest distance of a node from the surface at the node's parameters.
double node_error(const TopoDS_Face& face, std::size_t& triangles) {
  const OcctMeshReport report = value_of(triangulate(face, {.deflection = 0.01, .angle = 0.5}));
  EXPECT_TRUE(report.certified);
  triangles = report.triangles;
  TopLoc_Location place;
  const handle<Poly_Triangulation> made = BRep_Tool::Triangulation(face, place);
  const handle<Geom_Surface> surface = BRep_Tool::Surface(face);
  double most = 0;
  for (int k = 1; k <= made->NbNodes(); ++k) {
    const gp_Pnt2d at = made->UVNode(k);
    most = std::max(most, made->Node(k).Distance(surface->Value(at.X(), at.Y())));
  }
  return most;
}

TEST(StraightSplines, PlanesTakeTwoTriangles) {
  std::size_t triangles = 0;
  const auto plane = [](double u, double v) { return gp_Pnt(1 + u + 0.2 * v, 2 - 0.3 * v, 3 + 0.1 * u + v); };
  EXPECT_LE(node_error(face_of(knots(40, 3), knots(30, 2), plane), triangles), 1e-5);
  EXPECT_EQ(triangles, 2u);
}

TEST(StraightSplines, RuledOnesTakeOneRow) {
  std::size_t triangles = 0, turned = 0, of_one = 0;
  const auto wave = [](double u, double v) { return gp_Pnt(u, std::sin(u), v); };
  const auto wave_along_v = [](double u, double v) { return gp_Pnt(u, std::sin(v), v); };
  EXPECT_LE(node_error(face_of(knots(10, 3), knots(30, 2), wave), triangles), 1e-5);
  EXPECT_LE(node_error(face_of(knots(30, 2), knots(10, 3), wave_along_v), turned), 1e-5);
  EXPECT_LE(node_error(face_of(knots(10, 3), knots(1, 1), wave), of_one), 1e-5);
  EXPECT_EQ(triangles, of_one);
  EXPECT_EQ(turned, of_one);
}

// A straight line at another pace keeps its spans: parameters follow from them.
TEST(StraightSplines, ThePaceIsKept) {
  std::size_t triangles = 0;
  const auto uneven = [](double u, double v) { return gp_Pnt(u + 0.02 * u * u, v, 0); };
  EXPECT_LE(node_error(face_of(knots(12, 3), knots(5, 2), uneven), triangles), 1e-5);
  EXPECT_GE(triangles, 24u);
  const auto bent = [](double u, double v) { return gp_Pnt(u, v, u > 5 ? 1e-9 : 0); };
  EXPECT_LE(node_error(face_of(knots(12, 3), knots(1, 1), bent), triangles), 1e-5);
  EXPECT_GE(triangles, 24u);
}

}}  // namespace tessera::test
