#include "occt/map_checks.h"

#include <gtest/gtest.h>
#include <opencascade/BRep_Tool.hxx>
#include <opencascade/TopExp.hxx>
#include <opencascade/TopTools_IndexedMapOfShape.hxx>
#include <opencascade/TopoDS.hxx>
#include <opencascade/gp_Vec.hxx>

#include <algorithm>
#include <cmath>

#include "tessera/model.h"

namespace tessera::test {
namespace {

using opencascade::handle;

Vec3 vec(const gp_XYZ& p) { return {p.X(), p.Y(), p.Z()}; }

/// The data that the checks of one model share.
struct MapCheck {
  const OcctModel& all;
  TopTools_IndexedMapOfShape faces, edges;  ///< of the shape
  double tolerance = 0;
  std::string name;
  int points = 0;
};

/// A point of a face where the shape holds it, and the direction of du x dv.
struct FacePoint {
  Vec3 position, normal;
};

FacePoint point_of(const TopoDS_Face& face, double u, double v) {
  gp_Pnt p;
  gp_Vec du, dv;
  TopLoc_Location place;
  BRep_Tool::Surface(face, place)->D1(u, v, p, du, dv);
  for (gp_Vec* const d : {&du, &dv}) d->Transform(place.Transformation());
  p.Transform(place.Transformation());
  const Vec3 normal = vec(du.Crossed(dv).XYZ());
  return {vec(p.XYZ()), face.Orientation() == TopAbs_REVERSED ? -1.0 * normal : normal};
}

void expect_same_face(MapCheck& check, std::size_t surface) {
  const OcctModel& all = check.all;
  const TopoDS_Face face = all.face(surface);
  const std::string where = check.name + ", surface " + std::to_string(surface);
  ASSERT_FALSE(face.IsNull()) << where;
  ASSERT_TRUE(check.faces.Contains(face)) << where;
  const auto& spline = std::get<BSplineSurface>(all.model.surfaces[surface].surface);
  const Domain& d = spline.domain();
  for (int k = 0; k < 35; ++k) {
    const double u = d.u_at(k % 5 / 4.0), v = d.v_at(k / 5 / 6.0);
    const SurfaceJet ours = evaluate_jet(all.model.surfaces[surface], u, v).value();
    const OcctPoint at = all.at(surface, u, v);
    ASSERT_TRUE(at.face.IsEqual(face)) << where;
    const FacePoint theirs = point_of(face, at.u, at.v);
    EXPECT_LE(length(ours.position - theirs.position), check.tolerance) << where << " at " << u << ", " << v;
    const Vec3 normal = cross(ours.du, ours.dv);
    const double both = length(normal) * length(theirs.normal);
    EXPECT_TRUE(both < 1e-6 || dot(normal, theirs.normal) > 0.99 * both) << where << " at " << u << ", " << v;
    ++check.points;
  }
}

void expect_inverse(const OcctFace& face, const Domain& d, const std::string& where) {
  for (int k = 0; k < 35; ++k) {
    const double u = d.u_at(k % 5 / 4.0), v = d.v_at(k / 5 / 6.0);
    const std::array<double, 2> theirs = face.to_occt(u, v), back = face.from_occt(theirs[0], theirs[1]);
    EXPECT_NEAR(back[0], u, 1e-12 * std::max({1.0, std::abs(d.u0), std::abs(d.u1)})) << where;
    EXPECT_NEAR(back[1], v, 1e-12 * std::max({1.0, std::abs(d.v0), std::abs(d.v1)})) << where;
  }
}

void expect_same_edge(MapCheck& check, std::size_t instance, std::size_t k) {
  const OcctModel& all = check.all;
  const Instance& placed = all.model.instances[instance];
  const BrepEdge& ours = all.model.shapes[placed.shape].edges[k];
  const OcctParameter& parameter = all.shapes[placed.shape].edges[k].parameter;
  const TopoDS_Edge edge = all.edge(instance, k);
  const std::string where = check.name + ", edge " + std::to_string(k);
  ASSERT_FALSE(edge.IsNull()) << where;
  ASSERT_TRUE(check.edges.Contains(edge)) << where;
  EXPECT_EQ(BRep_Tool::Degenerated(edge), ours.degenerate) << where;
  double from = 0, to = 0;
  TopLoc_Location place;  // with it apart, parameters stay the edge's own also where it scales
  const handle<Geom_Curve> curve = BRep_Tool::Curve(edge, place, from, to);
  if (!ours.curve) return;
  for (int step = 0; step <= 16; ++step) {
    const double s = ours.range.from + (ours.range.to - ours.range.from) * step / 16, t = parameter.to_occt(s);
    EXPECT_GE(t, from - 1e-12 * std::max(1.0, std::abs(from))) << where;
    EXPECT_LE(t, to + 1e-12 * std::max(1.0, std::abs(to))) << where;
    EXPECT_NEAR(parameter.from_occt(t), s, 1e-12 * std::max({1.0, std::abs(from), std::abs(to)})) << where;
    const Vec3 point = placed.placement->point(position(*ours.curve, s));
    const gp_Pnt theirs = curve->Value(t).Transformed(place.Transformation());
    EXPECT_LE(length(point - vec(theirs.XYZ())), check.tolerance) << where << " at " << s;
    ++check.points;
  }
}

void expect_same_vertices(const MapCheck& check, std::size_t shape) {
  const std::vector<TopoDS_Vertex>& theirs = check.all.shapes[shape].vertices;
  const std::vector<BrepVertex>& ours = check.all.model.shapes[shape].vertices;
  ASSERT_EQ(theirs.size(), ours.size()) << check.name;
  for (std::size_t k = 0; k < ours.size(); ++k)
    EXPECT_TRUE(vec(BRep_Tool::Pnt(theirs[k]).XYZ()) == ours[k].position) << check.name;
}

}  // namespace

int expect_mapped(const OcctModel& all, const TopoDS_Shape& shape, const std::string& name, double fit) {
  MapCheck check{all, {}, {}, 0, name, 0};
  TopExp::MapShapes(shape, TopAbs_FACE, check.faces);
  TopExp::MapShapes(shape, TopAbs_EDGE, check.edges);
  Box3 box;
  for (const ModelSurface& surface : all.model.surfaces)
    for (const Vec3& point : std::get<BSplineSurface>(surface.surface).points())
      box.extend(surface.placement->point(point));
  check.tolerance = std::max(1e-9 * box.diagonal(), fit);
  EXPECT_EQ(all.shapes.size(), all.model.shapes.size()) << name;
  EXPECT_EQ(all.locations.size(), all.model.instances.size()) << name;
  for (std::size_t k = 0; k < all.model.surfaces.size(); ++k) expect_same_face(check, k);
  EXPECT_TRUE(all.face(all.model.surfaces.size()).IsNull() && all.at(all.model.surfaces.size(), 0, 0).face.IsNull());
  for (std::size_t k = 0; k < all.shapes.size(); ++k) {
    EXPECT_EQ(all.shapes[k].edges.size(), all.model.shapes[k].edges.size()) << name;
    expect_same_vertices(check, k);
    for (std::size_t face = 0; face < all.shapes[k].faces.size(); ++face)
      expect_inverse(all.shapes[k].faces[face],
                     std::get<BSplineSurface>(all.model.shapes[k].faces[face].surface).domain(), name);
  }
  for (std::size_t k = 0; k < all.model.instances.size(); ++k) {
    const std::size_t edges = all.shapes[all.model.instances[k].shape].edges.size();
    for (std::size_t edge = 0; edge < edges; ++edge) expect_same_edge(check, k, edge);
    EXPECT_TRUE(all.edge(k, edges).IsNull());
  }
  return check.points;
}

}  // namespace tessera::test
