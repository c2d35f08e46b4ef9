// Strips of many short spans get fewer, and stay where and how they are within the limits.

#include "exact/thinned_spline.h"

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
#include <functional>
#include <vector>

#include "support/synthetic_sets.h"
#include "tessera/nurbs_surface.h"
#include "tessera/occt_mesh.h"

namespace tessera::test { namespace {

using opencascade::handle;

/// Knots of single spans of slightly uneven lengths, clamped.
std::vector<double> uneven_knots(int spans, int degree) {
  std::vector<double> knots(static_cast<std::size_t>(degree), 0);
  for (int k = 0; k <= spans; ++k) knots.push_back((k + 0.01 * std::sin(3.0 * k)) / spans);
  knots.insert(knots.end(), static_cast<std::size_t>(degree), knots.back());
  return knots;
}

double greville(const SplineDirection& of, std::size_t k) {
  double sum = 0;
  for (int j = 1; j <= of.degree; ++j) sum += of.knots[k + static_cast<std::size_t>(j)];
  return sum / of.degree;
}

/// A strip along u whose control points are point(u, v) at the Greville abscissae.
StraightenedNet strip(int spans, int degree, int degree_across, const std::function<Vec3(double, double)>& point) {
  StraightenedNet net;
  net.u = {degree, uneven_knots(spans, degree), {}};
  net.v = {degree_across, uneven_knots(1, degree_across), {}};
  for (SplineDirection* of : {&net.u, &net.v}) of->part = {of->knots.front(), of->knots.back()};
  for (std::size_t i = 0; i + static_cast<std::size_t>(degree) + 1 < net.u.knots.size(); ++i)
    for (std::size_t j = 0; j <= static_cast<std::size_t>(degree_across); ++j)
      net.points.push_back(point(greville(net.u, i), greville(net.v, j)));
  return net;
}

StraightenedNet turned(const StraightenedNet& net) {
  StraightenedNet out{net.v, net.u, {}, {}};
  const std::size_t rows = net.v.knots.size() - static_cast<std::size_t>(net.v.degree) - 1;
  for (std::size_t j = 0; j < rows; ++j)
    for (std::size_t i = 0; i < net.points.size() / rows; ++i) out.points.push_back(net.points[i * rows + j]);
  return out;
}

BSplineSurface surface_of(const StraightenedNet& net) {
  return value_of(BSplineSurface::polynomial(net.u.degree, net.u.knots, net.v.degree, net.v.knots, net.points));
}

Vec3 wing(double u, double v) {
  return {u, 0.3 * v * (1 + 0.2 * u), 0.1 * std::sin(5 * u) + 0.05 * v * std::cos(3 * u)};
}

TEST(ThinnedSplines, MoveNoFartherThanTheySay) {
  for (const int degree : {2, 3, 5})
    for (const int across : {1, 2})
      for (const double distance : {1e-4, 1e-5}) {
        for (const bool is_turned : {false, true}) {
          const StraightenedNet net =
              is_turned ? turned(strip(180, degree, across, wing)) : strip(180, degree, across, wing);
          StraightenedNet thinned = net;
          const std::optional<SplineShift> shift = thin(thinned, {distance, 0.01});
          ASSERT_TRUE(shift.has_value()) << degree << " " << across << " " << distance;
          EXPECT_LE(thinned.points.size(), net.points.size() / (distance < 1e-4 ? 2 : 4));
          EXPECT_LE(shift->distance, distance);
          EXPECT_LE(shift->angle, 0.01);
          const BSplineSurface before = surface_of(net), after = surface_of(thinned);
          double moved = 0, bent = 0;
          for (int k = 0; k < 5000; ++k) {
            const Domain& d = before.domain();
            const double u = d.u_at(k % 1000 / 999.0), v = d.v_at(k / 1000 / 4.0);
            const SurfaceJet a = evaluate_jet(before, is_turned ? d.u_at(k / 1000 / 4.0) : u,
                                              is_turned ? d.v_at(k % 1000 / 999.0) : v),
                             b = evaluate_jet(after, is_turned ? d.u_at(k / 1000 / 4.0) : u,
                                              is_turned ? d.v_at(k % 1000 / 999.0) : v);
            moved = std::max(moved, length(a.position - b.position));
            bent = std::max(bent, length(cross(normalized(cross(a.du, a.dv)), normalized(cross(b.du, b.dv)))));
          }
          EXPECT_LE(moved, shift->distance);
          EXPECT_LE(std::asin(bent), shift->angle * (1 + 1e-9) + 1e-12);
          EXPECT_GE(moved, 0.02 * shift->distance);  // the bounds say something
          EXPECT_GE(bent, 0.005 * shift->angle);
        }
      }
}

TEST(ThinnedSplines, OthersStay) {
  const SplineShift most{1e-4, 0.01};
  const auto stays = [&](StraightenedNet net) {
    const std::vector<Vec3> before = net.points;
    return !thin(net, most) && net.points == before;
  };
  EXPECT_TRUE(stays(strip(20, 3, 1, wing)));   // few spans
  EXPECT_TRUE(stays(strip(180, 3, 9, wing)));  // wide
  EXPECT_TRUE(stays(strip(180, 3, 1, [](double u, double v) {
    return wing(u, v) + Vec3{0, 0, 0.01 * std::sin(400 * u)};
  })));
  EXPECT_TRUE(stays(strip(180, 1, 1, [](double u, double v) { return Vec3{u, v, std::abs(u - 0.25)}; })));
  StraightenedNet rational = strip(180, 3, 1, wing);
  rational.weights.assign(rational.points.size(), 1);
  EXPECT_TRUE(stays(rational));
  EXPECT_FALSE(thin(rational = strip(180, 3, 1, wing), {0, 0}).has_value());
  StraightenedNet point = strip(180, 3, 1, [](double, double) { return Vec3{1, 2, 3}; });
  EXPECT_FALSE(thin(point, most).has_value());  // no normals
}

handle<Geom_BSplineSurface> surface_in_occt(const StraightenedNet& net) {
  const auto values = [](const SplineDirection& of) {
    std::vector<double> out(of.knots.begin(), of.knots.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
  };
  const std::vector<double> u = values(net.u), v = values(net.v);
  TColStd_Array1OfReal knots_u(1, int(u.size())), knots_v(1, int(v.size()));
  TColStd_Array1OfInteger times_u(1, int(u.size())), times_v(1, int(v.size()));
  times_u.Init(1), times_v.Init(1);
  times_u(1) = times_u(int(u.size())) = net.u.degree + 1;
  times_v(1) = times_v(int(v.size())) = net.v.degree + 1;
  for (int k = 1; k <= int(u.size()); ++k) knots_u(k) = u[static_cast<std::size_t>(k - 1)];
  for (int k = 1; k <= int(v.size()); ++k) knots_v(k) = v[static_cast<std::size_t>(k - 1)];
  const int columns = int(net.v.knots.size()) - net.v.degree - 1, rows = int(net.points.size()) / columns;
  TColgp_Array2OfPnt poles(1, rows, 1, columns);
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j) {
      const Vec3& p = net.points[static_cast<std::size_t>(i * columns + j)];
      poles(i + 1, j + 1) = gp_Pnt(p.x, p.y, p.z);
    }
  return new Geom_BSplineSurface(poles, knots_u, knots_v, times_u, times_v, net.u.degree, net.v.degree);
}

/// Each point of the surface is compared with the one that its triangle has at the same parameters.
TEST(ThinnedSplines, TriangulationsKeepDeflectionAndAngle) {
  const handle<Geom_BSplineSurface> surface = surface_in_occt(strip(12, 3, 1, wing));
  for (int k = 0; k < 200; ++k) surface->InsertUKnot((k + 0.5) / 200, 1, 1e-9);
  const TopoDS_Face face = BRepBuilderAPI_MakeFace(surface, 1e-7).Face();
  const OcctMeshReport report = value_of(triangulate(face, {.deflection = 1e-3, .angle = 0.2}));
  EXPECT_LE(report.triangles, 120u);  // a span alone takes two
  EXPECT_TRUE(report.certified);
  EXPECT_LE(report.bound, 1e-3);
  EXPECT_LE(report.angle, 0.2);
  TopLoc_Location place;
  const handle<Poly_Triangulation> made = BRep_Tool::Triangulation(face, place);
  double off_node = 0;
  for (int k = 1; k <= made->NbNodes(); ++k)
    off_node = std::max(off_node, made->Node(k).Distance(surface->Value(made->UVNode(k).X(), made->UVNode(k).Y())));
  EXPECT_LE(off_node, 1e-3 / 64);
  for (int t = 1; t <= made->NbTriangles(); ++t) {
    int corner[3];
    made->Triangle(t).Get(corner[0], corner[1], corner[2]);
    for (int sample = 0; sample < 66; ++sample) {
      const int a = sample % 11, b = sample / 11 % 6;
      const double share[3] = {a / 10.0 * (b / 5.0), a / 10.0 * (1 - b / 5.0), 1 - a / 10.0};
      gp_XYZ at(0, 0, 0);
      gp_XY uv(0, 0);
      for (int c = 0; c < 3; ++c)
        at += share[c] * made->Node(corner[c]).XYZ(), uv += share[c] * made->UVNode(corner[c]).XY();
      gp_Pnt on;
      gp_Vec du, dv;
      surface->D1(uv.X(), uv.Y(), on, du, dv);
      EXPECT_LE(gp_Pnt(at).Distance(on), report.bound);
      for (const int node : corner) EXPECT_LE(gp_Vec(made->Normal(node)).Angle(du.Crossed(dv)), report.angle + 1e-6);
    }
  }
}

}}  // namespace tessera::test
