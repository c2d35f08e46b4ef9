// Points inside and outside of closed surfaces, against closed formulas; surfaces that are open or of several shells.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/quadrics.h"
#include "support/random_patches.h"
#include "support/ray_classes.h"
#include "support/torus.h"
#include "tessera/edge_matching.h"
#include "tessera/model.h"
#include "tessera/nurbs_surface.h"
#include "tessera/solid.h"

namespace tessera::test { namespace {

/// A set, its scene, and the solid of them.
struct SolidCase {
  explicit SolidCase(const std::vector<BezierPatch>& patches)
      : set(value_of(PatchSet::make(patches))),
        scene(value_of(RayScene::make(set))),
        solid(value_of(Solid::make(scene))) {}
  PatchSet set;
  RayScene scene;
  Solid solid;
};

std::vector<BezierPatch> joined(std::vector<BezierPatch> a, const std::vector<BezierPatch>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// The faces of a box, as bilinear patches with normals in or out at random.
std::vector<BezierPatch> box(const Vec3& from, const Vec3& to) {
  const auto at = [&](int k) {
    return Vec3{(k & 1) != 0 ? to.x : from.x, (k & 2) != 0 ? to.y : from.y, (k & 4) != 0 ? to.z : from.z};
  };
  std::vector<BezierPatch> out;
  for (const auto& [a, b, c, d] : std::initializer_list<std::array<int, 4>>{
           {0, 1, 2, 3}, {4, 5, 6, 7}, {0, 1, 4, 5}, {2, 3, 6, 7}, {0, 2, 4, 6}, {1, 3, 5, 7}})
    out.push_back(polynomial(1, 1, {at(a), at(b), at(c), at(d)}));
  return out;
}

template <class Inside>
void expect_sides(const Solid& solid, std::size_t count, double reach, double near, const Inside& depth,
                  const Vec3& about = {}) {
  Random random(1);
  std::vector<Vec3> points;
  for (std::size_t k = 0; k < count; ++k) points.push_back(about + reach * uniform_vector(random, -1, 1));
  std::vector<Containment> sides(count);
  ASSERT_TRUE(solid.contains(points, sides).ok());
  std::size_t certified = 0, inside = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const double deep = depth(points[k]);
    if (std::abs(deep) <= near) continue;
    EXPECT_EQ(sides[k].side, deep > 0 ? PointSide::inside : PointSide::outside) << k;
    certified += sides[k].certified, inside += deep > 0;
  }
  EXPECT_GE(certified, count * 99 / 100);
  EXPECT_GT(inside, count / 50);
}

TEST(SolidPoints, OfASphereATorusAndABox) {
  const SolidCase ball(sphere());
  EXPECT_TRUE(ball.solid.is_closed());
  expect_sides(ball.solid, 20000, 1.5, 1e-14, [](const Vec3& p) { return 1 - length(p); });
  const Torus shape(6);
  const SolidCase ring(shape.patches(false));
  EXPECT_TRUE(ring.solid.is_closed());
  const SolidCase block(box({-1, -0.5, -0.25}, {0.75, 1, 0.5}));
  EXPECT_TRUE(block.solid.is_closed());
  expect_sides(block.solid, 20000, 1.5, 0, [](const Vec3& p) {
    return std::min({p.x + 1, 0.75 - p.x, p.y + 0.5, 1 - p.y, p.z + 0.25, 0.5 - p.z});
  });
}

// Rays in one direction and parity in others agree; the bicubic body has creases.
TEST(SolidPoints, AgreeWithTheParityOfAllHits) {
  for (const std::vector<BezierPatch>& patches : {closed_body(), Torus(5).patches(true), Torus(6).patches(false)}) {
    const SolidCase body(patches);
    ASSERT_TRUE(body.solid.is_closed());
    Random random(2);
    std::size_t inside = 0;
    for (int k = 0; k < 3000; ++k) {
      const Vec3 point = 1.5 * uniform_vector(random, -1, 1);
      HitLists lists;
      const Ray ray{.origin = point, .direction = rays::unit_vector(random)};
      ASSERT_TRUE(body.scene.all({&ray, 1}, lists).ok());
      const bool is_clear = std::ranges::none_of(lists.hits, [](const Hit& hit) { return hit.flags.uncertified; });
      const Containment found = body.solid.contains(point);
      EXPECT_TRUE(found.certified);
      if (is_clear) {
        EXPECT_EQ(found.side == PointSide::inside, lists.hits.size() % 2 == 1);
      }
      inside += found.side == PointSide::inside;
    }
    EXPECT_GT(inside, 100u);
  }
}

TEST(SolidPoints, OfShellsThatTouchOrLieWithinEachOther) {
  // Two boxes with a common wall, of which one wall is larger.
  const SolidCase pair(joined(box({-1, -1, -1}, {0, 1, 1}), box({0, -0.5, -0.5}, {1, 0.5, 0.5})));
  EXPECT_TRUE(pair.solid.is_closed());
  expect_sides(pair.solid, 5000, 1.5, 1e-12, [](const Vec3& p) {
    const double left = std::min({p.x + 1, -p.x, 1 - std::abs(p.y), 1 - std::abs(p.z)});
    const double right = std::min({p.x, 1 - p.x, 0.5 - std::abs(p.y), 0.5 - std::abs(p.z)});
    return std::max(left, right);
  });
  const SolidCase hollow(joined(sphere(), placed(sphere(), 0.5, {0.2, 0, 0})));
  expect_sides(hollow.solid, 5000, 1.2, 1e-13, [](const Vec3& p) {
    return std::min(1 - length(p), length(p - Vec3{0.2, 0, 0}) - 0.5);
  });
}

/// A loop around [x0, x1] x [0, y1] in the plane.
TrimLoop rectangle_loop(double x0, double x1, double y1) {
  const auto line = [](const Vec3& a, const Vec3& b) { return value_of(Curve::bezier(std::vector<Vec3>{a, b})); };
  return {{line({x0, 0, 0}, {x1, 0, 0}), line({x1, 0, 0}, {x1, y1, 0}), line({x1, y1, 0}, {x0, y1, 0}),
           line({x0, y1, 0}, {x0, 0, 0})},
          false};
}

// One face is the bottom of a block and the top of another: it faces outwards to both sides.
TEST(SolidPoints, OfAFaceInTwoPieces) {
  std::vector<ModelSurface> faces;
  const auto add = [&](std::vector<BezierPatch> block, std::size_t without) {
    block.erase(block.begin() + static_cast<std::ptrdiff_t>(without));
    for (const BezierPatch& patch : block) faces.push_back({.name = std::string("side"), .surface = patch});
  };
  add(box({0, 0, 0}, {1, 1, 1}), 0);
  add(box({2, 0, -0.2}, {2.2, 0.2, 0}), 1);
  ModelSurface plane{.name = std::string("plane"),
                     .surface = value_of(BSplineSurface::polynomial(
                         1, std::vector<double>{-1, -1, 4, 4}, 1, std::vector<double>{-1, -1, 4, 4},
                         std::vector<Vec3>{{-1, -1, 0}, {-1, 4, 0}, {4, -1, 0}, {4, 4, 0}}))};
  plane.trims = std::vector<TrimLoop>{rectangle_loop(0, 1, 1), rectangle_loop(2, 2.2, 0.2)};
  faces.push_back(plane);
  const PatchSet set = value_of(make_patch_set(value_of(joined_shape(faces, 1e-6))));
  const RayScene scene = value_of(RayScene::make(set));
  const Solid solid = value_of(Solid::make(scene));
  EXPECT_TRUE(solid.is_closed());
  const auto depth = [](const Vec3& p) {
    const double above = std::min({p.x, 1 - p.x, p.y, 1 - p.y, p.z, 1 - p.z});
    const double below = std::min({p.x - 2, 2.2 - p.x, p.y, 0.2 - p.y, -p.z, p.z + 0.2});
    return std::max(above, below);
  };
  expect_sides(solid, 5000, 1, 1e-12, depth, {0.5, 0.5, 0.5});
  expect_sides(solid, 5000, 0.2, 1e-12, depth, {2.1, 0.1, -0.1});
  // The face is turned as one, so that one block has the number 1 and the other -1.
  const std::vector<Vec3> points{{0.5, 0.4, 0.3}, {2.1, 0.1, -0.1}, {2.1, 0.1, 0.1}, {1.5, 0.1, 0.1}};
  std::vector<double> numbers(points.size());
  ASSERT_TRUE(solid.winding_numbers(points, numbers).ok());
  EXPECT_NEAR(std::abs(numbers[0]), 1, 1e-12);
  EXPECT_NEAR(std::abs(numbers[1]), 1, 1e-12);
  EXPECT_NEAR(numbers[2], 0, 1e-12);
  EXPECT_NEAR(numbers[3], 0, 1e-12);
}

TEST(SolidPoints, OfOpenSurfacesAreNotCertified) {
  std::vector<BezierPatch> patches = box({-1, -1, -1}, {1, 1, 1});
  patches.pop_back();
  const SolidCase open(patches);
  EXPECT_FALSE(open.solid.is_closed());
  EXPECT_EQ(open.solid.open_borders(), 4u);
  EXPECT_FALSE(open.solid.contains({0, 0, 0}).certified);
  EXPECT_EQ(open.solid.contains({0, 0, 0}).side, PointSide::inside);
  EXPECT_EQ(open.solid.contains({3, 3, 3}).side, PointSide::outside);
}

TEST(SolidPoints, SignedDistancesOfASphere) {
  const SolidCase ball(sphere());
  const PointScene points = value_of(PointScene::make(ball.set));
  Random random(3);
  std::vector<Vec3> at;
  for (int k = 0; k < 1000; ++k) at.push_back(1.5 * uniform_vector(random, -1, 1));
  at.push_back({std::numeric_limits<double>::quiet_NaN(), 0, 0});
  std::vector<double> distances(at.size());
  ASSERT_TRUE(signed_distances(ball.solid, points, at, distances).ok());
  for (std::size_t k = 0; k + 1 < at.size(); ++k) EXPECT_NEAR(distances[k], length(at[k]) - 1, 1e-14);
  EXPECT_TRUE(std::isnan(distances.back()));
}

TEST(SolidPoints, WrongInput) {
  SolidCase ball(sphere());
  const std::vector<Vec3> points(3);
  std::vector<Containment> sides(2);
  EXPECT_EQ(ball.solid.contains(points, sides).code(), StatusCode::buffer_too_small);
  EXPECT_EQ(ball.solid.contains({0, 1e300, 0}).side, PointSide::invalid_point);
  EXPECT_EQ(ball.solid.contains({0, std::numeric_limits<double>::quiet_NaN(), 0}).side, PointSide::invalid_point);
  const RayScene grid = value_of(RayScene::make(ball.set, {.mode = RayMode::grid}));
  EXPECT_EQ(Solid::make(grid).status().code(), StatusCode::unsupported);
  const RayScene part = value_of(RayScene::make(ball.set, {.patches = 2}));
  EXPECT_EQ(Solid::make(part).status().code(), StatusCode::unsupported);
  ASSERT_TRUE(ball.set.set_control_points(0, ball.set.patch(1).points()).ok());
  EXPECT_EQ(ball.solid.contains({0, 0, 0}).side, PointSide::invalid_point);
  EXPECT_EQ(Solid::make(ball.scene).status().code(), StatusCode::stale);
}

}}  // namespace tessera::test
