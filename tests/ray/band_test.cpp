// Faces that go around without a seam edge: a can of a band and two discs.

#include <array>

#include "ray/ray_support.h"
#include "tessera/nurbs_surface.h"
#include "tessera/topology.h"

namespace tessera::test { namespace {

constexpr double height = 10;

Curve line(const Vec3& from, const Vec3& to) {
  return value_of(Curve::b_spline(1, std::array{from, to}, std::array{0.0, 0.0, 1.0, 1.0}));
}

/// The circle of radius 1 at a height, from 0 to 1.
Curve circle(double z) { return value_of(make_nurbs_circle({.origin = {0, 0, z}}, 1)); }

/// A square around the circle, whose parameters are x and y.
BSplineSurface square(double z) {
  const std::array<Vec3, 4> points{Vec3{-1, -1, z}, {-1, 1, z}, {1, -1, z}, {1, 1, z}};
  const std::array<double, 4> knots{-1, -1, 1, 1};
  return value_of(BSplineSurface::polynomial(1, knots, 1, knots, points));
}

Shape can() {
  Shape shape;
  shape.vertices = {{{1, 0, 0}}, {{1, 0, height}}};
  for (const std::uint32_t k : {0U, 1U}) shape.edges.push_back({.start = k, .end = k, .curve = circle(k * height)});
  const BSplineSurface band = value_of(make_nurbs_cylinder({}, 1, height));
  shape.faces.push_back({{"band", band}});
  shape.faces.back().trims = std::vector<TrimLoop>{{{line({0, 0, 0}, {1, 0, 0})}, false, {{0, false, {}}}},
                                                   {{line({1, 1, 0}, {0, 1, 0})}, false, {{1, true, {}}}}};
  for (const std::uint32_t k : {0U, 1U}) {
    shape.faces.push_back({{"disc", square(k * height)}});
    shape.faces.back().trims = std::vector<TrimLoop>{{{circle(0)}, false, {{k, false, {}}}}};
  }
  return shape;
}

// The line along the seam, from one loop to the other, lies at no vertex.
TEST(Band, HasNoTubeAlongItsSeam) {
  const Shape shape = can();
  ASSERT_TRUE(check_topology(shape).ok()) << check_topology(shape).message();
  const PatchSet set = value_of(make_patch_set(shape));
  const RayScene scene = value_of(RayScene::make(set));
  for (const double gap : value_of(scene.edge_gaps())) EXPECT_LT(gap, 1e-8);
  for (const double x : {1.01, 2.0, 5.0, 9.0}) {
    EXPECT_EQ(scene.closest(ray({x, -20, 0.5 * height}, {0, 1, 0})).kind, HitKind::miss) << x;
    EXPECT_EQ(scene.closest(ray({x, -20, -1e-3}, {0, 1, 0})).kind, HitKind::miss) << x;
  }
  const Hit hit = scene.closest(ray({0, -20, 0.5 * height}, {0, 1, 0}));
  EXPECT_EQ(hit.kind, HitKind::hit);
  EXPECT_NEAR(hit.t, 19, 1e-12);
}

}}  // namespace tessera::test
