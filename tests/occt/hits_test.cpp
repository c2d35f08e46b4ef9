// Rays, nearest points and sides of a shape in memory, and the faces that they name.

#include <gtest/gtest.h>
#include <opencascade/BRepBuilderAPI_MakeVertex.hxx>
#include <opencascade/BRepClass3d_SolidClassifier.hxx>
#include <opencascade/BRepClass_FaceClassifier.hxx>
#include <opencascade/BRepExtrema_DistShapeShape.hxx>
#include <opencascade/BRep_Tool.hxx>
#include <opencascade/IntCurvesFace_ShapeIntersector.hxx>
#include <opencascade/TopExp.hxx>
#include <opencascade/TopTools_IndexedMapOfShape.hxx>
#include <opencascade/TopoDS.hxx>
#include <opencascade/gp_Lin.hxx>

#include <limits>
#include <random>

#include "occt/occt_shapes.h"
#include "tessera/occt.h"
#include "tessera/queries.h"
#include "tessera/ray_scene.h"
#include "tessera/throw.h"

namespace tessera::test { namespace {

/// Drilled boxes at three places, one of them turned and reversed.
TopoDS_Compound bodies() {
  gp_Trsf turn;
  turn.SetRotation(gp_Ax1(gp_Pnt(1, 0, 0), gp_Dir(1, 2, 3)), 1.2);
  const TopoDS_Shape drilled = drilled_box();
  return compound_of({drilled, drilled.Moved(shift(0, 0, 6)), drilled.Moved(turn).Moved(shift(9, 0, 0))});
}

Vec3 point_in(std::mt19937_64& random) {
  std::uniform_real_distribution<double> place(-2, 13);
  return {place(random), 0.4 * place(random), 0.6 * place(random)};
}

gp_Pnt pnt(const Vec3& p) { return {p.x, p.y, p.z}; }

/// Expects that a point of the model lies in the face that the map names.
void expect_on_face(const OcctPoint& at, const Vec3& position, const TopTools_IndexedMapOfShape& faces) {
  ASSERT_FALSE(at.face.IsNull());
  EXPECT_TRUE(faces.Contains(at.face));
  const gp_Pnt point = BRep_Tool::Surface(at.face)->Value(at.u, at.v);
  EXPECT_LE(point.Distance(pnt(position)), 1e-8);
  const BRepClass_FaceClassifier side(at.face, gp_Pnt2d(at.u, at.v), 1e-6);
  EXPECT_TRUE(side.State() == TopAbs_IN || side.State() == TopAbs_ON);
}

TEST(OcctHits, NameTheFace) {
  const TopoDS_Compound shape = bodies();
  const OcctModel all = value_or_throw(model_from(shape));
  const RayScene scene = value_or_throw(RayScene::make(all.model));
  TopTools_IndexedMapOfShape faces;
  TopExp::MapShapes(shape, TopAbs_FACE, faces);
  IntCurvesFace_ShapeIntersector peer;
  peer.Load(shape, 1e-7);
  std::mt19937_64 random(5);
  int hits = 0;
  for (int k = 0; k < 400; ++k) {
    const Vec3 origin = point_in(random), direction = normalized(point_in(random) - origin);
    const Hit hit = scene.closest({origin, direction});
    peer.Perform(gp_Lin(pnt(origin), gp_Dir(direction.x, direction.y, direction.z)), 0, 1e6);
    ASSERT_EQ(hit.kind == HitKind::hit, peer.NbPnt() > 0) << k;
    if (hit.kind != HitKind::hit) continue;
    ++hits;
    int first = 1;  // PerformNearest() frees an array as if it were none
    for (int one = 2; one <= peer.NbPnt(); ++one)
      if (peer.WParameter(one) < peer.WParameter(first)) first = one;
    const OcctPoint at = all.at(hit.surface, hit.u, hit.v);
    expect_on_face(at, hit.position, faces);
    EXPECT_NEAR(hit.t, peer.WParameter(first), 1e-6);
    EXPECT_TRUE(hit.flags.edge || at.face.IsSame(peer.Face(first))) << k;
  }
  EXPECT_GT(hits, 60);
}

TEST(OcctHits, NearestPointsAreThoseOfOpenCascade) {
  const TopoDS_Compound shape = bodies();
  const OcctModel all = value_or_throw(model_from(shape));
  const PointScene scene = value_or_throw(PointScene::make(all.model));
  TopTools_IndexedMapOfShape faces;
  TopExp::MapShapes(shape, TopAbs_FACE, faces);
  std::mt19937_64 random(6);
  for (int k = 0; k < 40; ++k) {
    const Vec3 point = point_in(random);
    const NearestPoint found = scene.nearest(point);
    ASSERT_EQ(found.kind, NearestKind::found);
    expect_on_face(all.at(found.surface, found.u, found.v), found.position, faces);
    // OpenCASCADE has the distance of a solid from a point inside as 0: so that of each face counts.
    double nearest = std::numeric_limits<double>::infinity();
    const TopoDS_Shape vertex = BRepBuilderAPI_MakeVertex(pnt(point)).Vertex();
    for (int face = 1; face <= faces.Extent(); ++face)
      nearest = std::min(nearest, BRepExtrema_DistShapeShape(vertex, faces(face)).Value());
    EXPECT_NEAR(found.distance, nearest, 1e-6) << k;
  }
}

TEST(OcctHits, InsideIsThatOfOpenCascade) {
  const TopoDS_Compound shape = bodies();
  const OcctModel all = value_or_throw(model_from(shape));
  const RayScene scene = value_or_throw(RayScene::make(all.model));
  const Solid solid = value_or_throw(Solid::make(scene));
  std::mt19937_64 random(7);
  std::vector<Vec3> points(200);
  for (Vec3& point : points) point = point_in(random);
  std::vector<Containment> sides(points.size());
  throw_if_failed(solid.contains(points, sides));
  int inside = 0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    bool expected = false;
    for (TopExp_Explorer body(shape, TopAbs_SOLID); body.More(); body.Next())
      expected = expected || BRepClass3d_SolidClassifier(body.Current(), pnt(points[k]), 1e-7).State() == TopAbs_IN;
    EXPECT_EQ(sides[k].side == PointSide::inside, expected) << k;
    inside += expected;
  }
  EXPECT_GT(inside, 5);
}

}}  // namespace tessera::test
