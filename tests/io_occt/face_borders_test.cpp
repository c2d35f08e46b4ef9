// Borders of faces whose curves are stated oddly: too short, over a seam, inside the face, beside the surface.

#include <gtest/gtest.h>
#include <opencascade/BRepBuilderAPI_MakeEdge.hxx>
#include <opencascade/BRepBuilderAPI_MakeFace.hxx>
#include <opencascade/BRepBuilderAPI_MakeWire.hxx>
#include <opencascade/BRepLib.hxx>
#include <opencascade/BRepPrimAPI_MakePrism.hxx>
#include <opencascade/BRep_Builder.hxx>
#include <opencascade/BRep_Tool.hxx>
#include <opencascade/GCE2d_MakeSegment.hxx>
#include <opencascade/Geom2d_BSplineCurve.hxx>
#include <opencascade/Geom2d_BezierCurve.hxx>
#include <opencascade/Geom2d_TrimmedCurve.hxx>
#include <opencascade/Geom_BSplineCurve.hxx>
#include <opencascade/Geom_BSplineSurface.hxx>
#include <opencascade/Geom_Line.hxx>
#include <opencascade/Geom_Plane.hxx>
#include <opencascade/Geom_RectangularTrimmedSurface.hxx>
#include <opencascade/Geom_ToroidalSurface.hxx>
#include <opencascade/TColgp_Array1OfPnt.hxx>
#include <opencascade/TColgp_Array1OfPnt2d.hxx>
#include <opencascade/TColgp_Array2OfPnt.hxx>
#include <opencascade/TopoDS.hxx>
#include <opencascade/gp_Pln.hxx>

#include <cmath>
#include <numbers>

#include "io_occt/cad_shapes.h"
#include "support/scratch_folder.h"
#include "tess_trim/closed_shape.h"
#include "tessera/cad.h"
#include "tessera/topology.h"

namespace tessera::test { namespace {

using opencascade::handle;

/// A curve of a border over its whole range.
using Border = std::vector<handle<Geom2d_Curve>>;

Border polygon_border(const std::vector<gp_Pnt2d>& corners) {
  Border border;
  for (std::size_t k = 0; k < corners.size(); ++k)
    border.push_back(GCE2d_MakeSegment(corners[k], corners[(k + 1) % corners.size()]).Value());
  return border;
}

TopoDS_Edge edge_on(const handle<Geom_Surface>& surface, const handle<Geom2d_Curve>& curve) {
  const TopoDS_Edge edge = BRepBuilderAPI_MakeEdge(curve, surface, curve->FirstParameter(), curve->LastParameter());
  BRepLib::BuildCurve3d(edge);
  return edge;
}

TopoDS_Wire wire_of(const std::vector<TopoDS_Edge>& edges) {
  BRepBuilderAPI_MakeWire wire;
  for (const TopoDS_Edge& edge : edges) wire.Add(edge);
  EXPECT_TRUE(wire.IsDone());
  return wire.Wire();
}

std::vector<TopoDS_Edge> edges_on(const handle<Geom_Surface>& surface, const Border& border) {
  std::vector<TopoDS_Edge> edges;
  for (const handle<Geom2d_Curve>& curve : border) edges.push_back(edge_on(surface, curve));
  return edges;
}

TopoDS_Face face_on(const handle<Geom_Surface>& surface, const std::vector<TopoDS_Edge>& edges) {
  TopoDS_Face face;
  BRep_Builder().MakeFace(face, surface, 1e-7);
  BRep_Builder().Add(face, wire_of(edges));
  return face;
}

Model read(const TopoDS_Shape& shape) {
  const ScratchFolder folder;
  write_cad(shape, folder / "shape.brep");
  return value_of(read_by_opencascade(folder / "shape.brep"));
}

double area_of(const Shape& shape) {
  return volume_and_area(mesh_of(shape, {.tolerance = 1e-4, .relative = true}).mesh)[1];
}

/// The plane z = 0; edges and faces on it share it, as curves belong to one surface.
const handle<Geom_Surface>& plane() {
  static const handle<Geom_Surface> shared = new Geom_Plane(gp_Pln());
  return shared;
}

/// A straight spline from a to b over [from, to].
handle<Geom2d_BSplineCurve> straight_spline(const gp_Pnt2d& a, const gp_Pnt2d& b, double from, double to) {
  TColgp_Array1OfPnt2d poles(1, 2);
  poles(1) = a, poles(2) = b;
  TColStd_Array1OfReal knots(1, 2);
  knots(1) = from, knots(2) = to;
  TColStd_Array1OfInteger multiplicities(1, 2);
  multiplicities.Init(2);
  return new Geom2d_BSplineCurve(poles, knots, multiplicities, 1);
}

/// A rectangle of 10 x 8 without a corner of legs 0.6 c and 0.8 c: the cut's curve in the plane is stated from `first`
/// to c, its edge from 0 to c.
TopoDS_Face face_with_short_curve(double c, double first) {
  const gp_Pnt2d a(10, 8 - 0.8 * c), b(10 - 0.6 * c, 8);
  Border border = polygon_border({{0, 0}, {10, 0}, a, b, {0, 8}});
  border[2] = straight_spline(a, b, first, c);
  const std::vector<TopoDS_Edge> edges = edges_on(plane(), border);
  const handle<Geom_Line> line = new Geom_Line(gp_Pnt(a.X(), a.Y(), 0), gp_Dir(-0.6, 0.8, 0));
  BRep_Builder().UpdateEdge(edges[2], line, 1e-7);
  BRep_Builder().Range(edges[2], 0, c);
  return face_on(plane(), edges);
}

TEST(FaceBorders, ACurveMayEndBeforeItsEdgeByRounding) {
  const double c = 1.5e-6;
  const Model model = read(face_with_short_curve(c, 2e-10));
  ASSERT_EQ(model.surfaces.size(), 1u);
  EXPECT_TRUE(model.warnings.empty()) << model.warnings[0];
  const std::vector<TrimLoop>& loops = edge_loops(model.shapes[0].faces[0]);
  ASSERT_EQ(loops.size(), 1u);
  EXPECT_EQ(loops[0].coedges.size(), 5u);
  for (std::size_t k = 0; k < loops[0].coedges.size(); ++k) {
    const Coedge& coedge = loops[0].coedges[k];
    if (!coedge.parameter) continue;
    const Interval range = model.shapes[0].edges[coedge.edge].range, domain = loops[0].curves[k].domain();
    for (const double s : {range.from, 0.5 * (range.from + range.to), range.to}) {
      const double t = evaluate_jet(*coedge.parameter, s).position.x;
      EXPECT_GE(t, domain.from);
      EXPECT_LE(t, domain.to);
      EXPECT_NEAR(t, s, 2e-10);  // not shifted: the curve's parameter is the edge's
    }
  }
}

TEST(FaceBorders, ACurveOfHalfItsEdgeCostsTheSharedEdgesOnly) {
  const Model model = read(face_with_short_curve(2, 1));
  ASSERT_EQ(model.surfaces.size(), 1u);
  ASSERT_EQ(model.warnings.size(), 1u);
  EXPECT_NE(model.warnings[0].find(": face 0 is read without shared edges: "), std::string::npos) << model.warnings[0];
  EXPECT_NEAR(area_of(model.shapes[0]), 80 - 0.5 * 1.2 * 1.6, 1e-5);
}

TEST(FaceBorders, PartsOfBezierCurvesKeepTheirParameters) {
  TColgp_Array1OfPnt2d poles(1, 3);
  poles(1) = gp_Pnt2d(-4, 3), poles(2) = gp_Pnt2d(2, -5), poles(3) = gp_Pnt2d(12, 2);
  const handle<Geom2d_Curve> bow = new Geom2d_TrimmedCurve(new Geom2d_BezierCurve(poles), 0.25, 0.75);
  const gp_Pnt2d a = bow->Value(0.25), b = bow->Value(0.75);
  Border border = polygon_border({a, b, {b.X(), 8}, {a.X(), 8}});
  border[0] = bow;
  const Model model = read(face_on(plane(), edges_on(plane(), border)));
  const TrimLoop& loop = edge_loops(model.shapes.at(0).faces.at(0)).at(0);
  ASSERT_EQ(loop.coedges.size(), 4u);
  for (std::size_t k = 0; k < 4; ++k) {
    const BrepEdge& edge = model.shapes[0].edges[loop.coedges[k].edge];
    ASSERT_TRUE(edge.curve);
    for (int i = 0; i <= 16; ++i) {
      const double s = edge.range.from + (edge.range.to - edge.range.from) * i / 16;
      const std::optional<Curve>& parameter = loop.coedges[k].parameter;
      const double even = loop.coedges[k].reversed ? edge.range.from + edge.range.to - s : s;
      const double t = parameter ? evaluate_jet(*parameter, s).position.x : even;
      const Vec3 uv = evaluate_jet(loop.curves[k], t).position;
      EXPECT_LT(length(evaluate_jet(*edge.curve, s).position - uv), 1e-6) << k << ' ' << i;
    }
  }
}

TEST(FaceBorders, InternalAndExternalEdgesBoundNothing) {
  const std::vector<gp_Pnt2d> inside{{2, 2}, {8, 2}, {8, 8}, {2, 8}}, beside{{20, 2}, {28, 2}, {28, 8}, {20, 8}};
  for (const TopAbs_Orientation orientation : {TopAbs_INTERNAL, TopAbs_EXTERNAL}) {
    TopoDS_Face face = face_on(plane(), edges_on(plane(), polygon_border({{0, 0}, {10, 0}, {10, 10}, {0, 10}})));
    const bool internal = orientation == TopAbs_INTERNAL;
    TopoDS_Wire wire;
    BRep_Builder().MakeWire(wire);
    for (const TopoDS_Edge& edge : edges_on(plane(), polygon_border(internal ? inside : beside)))
      BRep_Builder().Add(wire, edge.Oriented(orientation));
    BRep_Builder().Add(face, wire);
    const Model model = read(face);
    ASSERT_EQ(model.surfaces.size(), 1u);
    EXPECT_TRUE(model.warnings.empty());
    EXPECT_NEAR(area_of(model.shapes[0]), 100, 1e-5);
    EXPECT_TRUE(model.surfaces[0].trims->empty());
  }
}

TEST(FaceBorders, AFaceMayLeaveTheRectangleThatTrimsItsSurface) {
  // The outer half of a tube, half a turn of it: u runs over the seam where the rectangle begins.
  const double pi = std::numbers::pi;
  const handle<Geom_Surface> torus = new Geom_ToroidalSurface(gp_Ax3(), 5, 2);
  const handle<Geom_Surface> part = new Geom_RectangularTrimmedSurface(torus, 0, 2 * pi, -pi, pi);
  const Border border = polygon_border({{-pi / 2, -pi / 2}, {pi / 2, -pi / 2}, {pi / 2, pi / 2}, {-pi / 2, pi / 2}});
  const Model model = read(face_on(part, edges_on(part, border)));
  ASSERT_EQ(model.surfaces.size(), 1u);
  // The integral of 2 (5 + 2 cos v) over v from -pi/2 to pi/2, half a turn.
  EXPECT_NEAR(area_of(model.shapes[0]), pi * 2 * (5 * pi + 4), 0.05);
}

/// A closed curve in the plane, periodic from knot 0 to 7.
handle<Geom_BSplineCurve> closed_spline() {
  const int count = 7;
  TColgp_Array1OfPnt poles(1, count);
  TColStd_Array1OfReal knots(1, count + 1);
  TColStd_Array1OfInteger multiplicities(1, count + 1);
  multiplicities.Init(1);
  for (int k = 1; k <= count; ++k) {
    const double angle = 2 * std::numbers::pi * k / count, radius = k % 3 == 0 ? 9 : 5;
    poles(k) = gp_Pnt(radius * std::cos(angle), radius * std::sin(angle), 0);
  }
  for (int k = 0; k <= count; ++k) knots(k + 1) = k;
  return new Geom_BSplineCurve(poles, knots, multiplicities, 3, true);
}

TEST(FaceBorders, EdgesMayStartAwayFromTheFirstKnotOfPeriodicSplines) {
  const handle<Geom_BSplineCurve> curve = closed_spline();
  double area = 0;
  const int steps = 20000;
  for (int k = 0; k < steps; ++k) {
    const gp_Pnt p = curve->Value(7.0 * k / steps), q = curve->Value(7.0 * (k + 1) / steps);
    area += 0.5 * (p.X() * q.Y() - p.Y() * q.X());
  }
  for (const double start : {0.0, 1.3, 2.0, 3.7, 6.9}) {
    const TopoDS_Edge edge = BRepBuilderAPI_MakeEdge(curve, start, start + 7);
    const TopoDS_Face base = BRepBuilderAPI_MakeFace(gp_Pln(), wire_of({edge}));
    const ScratchFolder folder;
    for (const char* const name : {"prism.brep", "prism.step"}) {
      write_cad(BRepPrimAPI_MakePrism(base, gp_Vec(0, 0, 3)).Shape(), folder / name);
      const Model model = value_of(read_by_opencascade(folder / name));
      ASSERT_EQ(model.shapes.size(), 1u);
      const ShapeMesh made = mesh_of(model.shapes[0], {.tolerance = 1e-4, .relative = true});
      EXPECT_EQ(made.report.open_edges, 0u) << start << ' ' << name;
      EXPECT_NEAR(volume_and_area(made.mesh)[0], 3 * area, 0.01 * area) << start << ' ' << name;
    }
  }
}

/// The square of 10 x 10 over [0, 1]^2.
handle<Geom_Surface> bilinear_square() {
  TColgp_Array2OfPnt poles(1, 2, 1, 2);
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j) poles(i + 1, j + 1) = gp_Pnt(10 * i, 10 * j, 0);
  TColStd_Array1OfReal knots(1, 2);
  knots(1) = 0, knots(2) = 1;
  TColStd_Array1OfInteger multiplicities(1, 2);
  multiplicities.Init(2);
  return new Geom_BSplineSurface(poles, knots, knots, multiplicities, multiplicities, 1, 1);
}

TEST(FaceBorders, CurvesThatLeaveTheSurfaceWithinTheToleranceFollowItsSide) {
  // A corner lies 0.005 beside the square.
  const handle<Geom_Surface> square = bilinear_square();
  for (const double tolerance : {1e-3, 1e-2}) {
    const std::vector<TopoDS_Edge> edges = edges_on(square, polygon_border({{0.2, 0}, {1.0005, 0.3}, {0.6, 1}}));
    for (const TopoDS_Edge& edge : edges) BRep_Builder().UpdateEdge(edge, tolerance);
    const Model model = read(face_on(square, edges));
    const TrimLoop& loop = edge_loops(model.shapes.at(0).faces.at(0)).at(0);
    EXPECT_EQ(loop.coedges.size(), 3u);
    double largest = 0;
    for (const Curve& curve : loop.curves)
      for (const Vec3& p : curve.points()) largest = std::max(largest, p.x);
    EXPECT_NEAR(largest, tolerance == 1e-3 ? 1.0005 : 1, 1e-12);
  }
}

}}  // namespace tessera::test
