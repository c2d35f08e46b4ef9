// Winding numbers of open and closed surfaces, against closed formulas and along many directions.

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cstring>
#include <limits>

#include "query/winding_case.h"
#include "support/torus.h"

namespace tessera::test { namespace {

std::vector<BezierPatch> hemisphere() {
  std::vector<BezierPatch> all = sphere();
  all.erase(all.begin() + 4, all.end());  // keeps those with z >= 0
  return all;
}

/// The box [-1, 1]^3 without its lid at z = 1, each face shrunk by a share about its centre; normals point in or out.
std::vector<BezierPatch> open_box(double shrink) {
  const auto at = [](double x, double y, double z) { return Vec3{x, y, z}; };
  const double s = 1 - shrink;
  return {quad(at(-s, -s, -1), at(-s, s, -1), at(s, -s, -1), at(s, s, -1)),
          quad(at(-1, -s, -s), at(-1, s, -s), at(-1, -s, s), at(-1, s, s)),
          quad(at(1, -s, -s), at(1, s, -s), at(1, -s, s), at(1, s, s)),
          quad(at(-s, -1, -s), at(s, -1, -s), at(-s, -1, s), at(s, -1, s)),
          quad(at(-s, 1, -s), at(-s, 1, s), at(s, 1, -s), at(s, 1, s))};
}
/// The number of a point with regard to that box, for outward normals: five rectangles.
double open_box_number(const Vec3& p, double shrink) {
  const double s = 1 - shrink;
  const auto face = [&](double x, double y, double depth) { return rectangle_share({x, y, depth}, -s, s, -s, s); };
  return face(p.x, p.y, -1 - p.z) + face(p.y, p.z, p.x - 1) + face(p.y, p.z, -1 - p.x) + face(p.x, p.z, p.y - 1) +
         face(p.x, p.z, -1 - p.y);
}

ModelSurface plane(double reach) {
  return {
      .name = std::string("plane"),
      .surface = value_of(BSplineSurface::polynomial(
          1, std::vector<double>{-reach, -reach, reach, reach}, 1, std::vector<double>{-reach, -reach, reach, reach},
          std::vector<Vec3>{{-reach, -reach, 0}, {-reach, reach, 0}, {reach, -reach, 0}, {reach, reach, 0}}))};
}

Model one_surface(ModelSurface surface) {
  Model model;
  model.surfaces.push_back(std::move(surface));
  return model;
}

TEST(WindingNumbers, OfAHemisphereFromItsAxis) {
  const WindingCase dome(hemisphere());
  EXPECT_EQ(dome.solid.open_borders(), 4u);
  for (const double h : {-1e6, -5.0, -1.0, -0.3, -1e-3, 1e-3, 0.2, 0.7, 0.999}) {
    const double expected = h < 0 ? disc_share(-h) : 1 - disc_share(h);
    EXPECT_NEAR(dome.at({0, 0, h}), expected, 1e-8) << h;
  }
  for (const double h : {1.001, 2.0, 1e3}) EXPECT_NEAR(dome.at({0, 0, h}), -disc_share(h), 1e-8) << h;
  EXPECT_EQ(dome.solid.contains({0, 0, 0.1}).side, PointSide::inside);
  EXPECT_EQ(dome.solid.contains({0, 0, -0.1}).side, PointSide::outside);
  EXPECT_FALSE(dome.solid.contains({0, 0, 0.1}).certified);
  EXPECT_EQ(dome.solid.contains({0, 0, 0}).side, PointSide::unknown);
}

TEST(WindingNumbers, OfABoxWithoutALid) {
  const WindingCase box(open_box(0));
  EXPECT_EQ(box.solid.open_borders(), 4u);
  Random random(1);
  std::size_t inside = 0;
  for (int k = 0; k < 3000; ++k) {
    const Vec3 p = (k % 2 == 0 ? 1.5 : 6.0) * uniform_vector(random, -1, 1);
    EXPECT_NEAR(box.at(p), open_box_number(p, 0), 1e-8) << k;
    inside += box.solid.contains(p).side == PointSide::inside;
  }
  EXPECT_GT(inside, 200u);
  EXPECT_NEAR(box.at({0, 0, 0}), 5.0 / 6, 1e-9);
  EXPECT_NEAR(box.at({0, 0, 1}), 0.5, 1e-8);
}

TEST(WindingNumbers, OfABoxWithGaps) {
  for (const double gap : {1e-3, 1e-2}) {
    const WindingCase box(open_box(gap));
    EXPECT_EQ(box.solid.open_borders(), 20u);
    Random random(2);
    for (int k = 0; k < 1000; ++k) {
      const Vec3 p = 2.0 * uniform_vector(random, -1, 1);
      EXPECT_NEAR(box.at(p), open_box_number(p, gap), 1e-8) << k;
    }
  }
}

TEST(WindingNumbers, OfADiscInAPlane) {
  ModelSurface face = plane(2);
  face.trims = std::vector<TrimLoop>{circle_loop(0, 0, 1, false)};
  const WindingCase disc(one_surface(face));
  for (const double h : {-40.0, -1.0, -0.3, -1e-4}) EXPECT_NEAR(disc.at({0, 0, h}), disc_share(-h), 1e-8) << h;
  for (const double h : {40.0, 1.0, 0.3, 1e-4}) EXPECT_NEAR(disc.at({0, 0, h}), -disc_share(h), 1e-8) << h;
  // A ring: the square less the disc.
  face.trims = std::vector<TrimLoop>{circle_loop(0, 0, 1, true)};
  const WindingCase ring(one_surface(face));
  for (const double h : {-3.0, -0.5, 0.4, 2.0}) {
    const Vec3 p{0, 0, h};
    const double hole = h < 0 ? disc_share(-h) : -disc_share(h);
    EXPECT_NEAR(ring.at(p), rectangle_share(p, -2, 2, -2, 2) - hole, 1e-8) << h;
  }
}

TEST(WindingNumbers, DoNotDependOnTheDirection) {
  std::vector<BezierPatch> torn = Torus(6).patches(true);
  for (const int k : {29, 14, 13, 3}) torn.erase(torn.begin() + k);
  ModelSurface face = plane(2);
  face.trims = std::vector<TrimLoop>{circle_loop(0.3, 0.2, 0.9, false), circle_loop(0.4, 0.1, 0.4, true)};
  ModelSurface ball{.name = std::string("ball"), .surface = value_of(make_nurbs_sphere({}, 1))};
  ball.trims = std::vector<TrimLoop>{circle_loop(0.6, 0.1, 0.05, true)};
  const WindingCase cases[] = {WindingCase(hemisphere()),      WindingCase(open_box(0)),
                               WindingCase(open_box(1e-3)),    WindingCase(torn),
                               WindingCase(one_surface(face)), WindingCase(one_surface(ball))};
  for (const WindingCase& one : cases) {
    Random random(3);
    double most = 0;
    for (int k = 0; k < 200; ++k) {
      const Vec3 p = (k % 3 == 0 ? 0.3 : 1.5) * uniform_vector(random, -1, 1);
      most = std::max(most, spread_of(one, p, random, 40));
    }
    EXPECT_LE(most, 1e-8) << &one - cases;
  }
}

// Cusps, collapsed sides, weights from 1 to 1e6, high degrees; points anywhere, and down to 1e-9 of the size from
// borders.
TEST(WindingNumbers, OfDifficultSurfacesDoNotDependOnTheDirection) {
  std::size_t open = 0;
  for (const RayClass& one : ray_classes()) {
    const WindingCase of(one.patches);
    const Box3 box = of.set.box();
    Random random(9);
    double most = 0;
    for (int k = 0; k < 40; ++k) {
      Vec3 p = box.centre() + 0.4 * box.diagonal() * uniform_vector(random, -1, 1);
      if (k % 2 == 0) {
        const BezierPatch& patch = rays::any_of(one.patches, random);
        const Vec3 border = de_casteljau(patch, uniform(random, 0, 1), k % 4 == 0 ? 0 : 1);
        p = border + rays::power(random, 1e-9, 1e-2) * box.diagonal() * rays::unit_vector(random);
      }
      most = std::max(most, spread_of(of, p, random, 10));
    }
    EXPECT_LE(most, of.solid.is_closed() ? 1e-12 : 1e-6) << one.name;
    open += !of.solid.is_closed();
  }
  EXPECT_GT(open, 5u);
}

// Where no orientation exists, the strip is cut open, and the number is still one of a surface.
TEST(WindingNumbers, OfAMoebiusStrip) {
  constexpr int count = 24;
  const auto place = [](int k, double aside) {
    const double angle = 2 * std::numbers::pi * (k % count) / count;
    const double side = k >= count ? -aside : aside;
    const double radius = 1 + side * std::cos(angle / 2);
    return Vec3{radius * std::cos(angle), radius * std::sin(angle), side * std::sin(angle / 2)};
  };
  std::vector<BezierPatch> patches;
  for (int k = 0; k < count; ++k)
    patches.push_back(quad(place(k, -0.3), place(k, 0.3), place(k + 1, -0.3), place(k + 1, 0.3)));
  const WindingCase strip(patches);
  EXPECT_EQ(strip.solid.open_borders(), 2u * count);
  Random random(4);
  for (int k = 0; k < 100; ++k) EXPECT_LE(spread_of(strip, 1.5 * uniform_vector(random, -1, 1), random, 40), 1e-8);
}

TEST(WindingNumbers, OfClosedSurfacesAreThoseOfContains) {
  std::vector<BezierPatch> hollow = sphere(), cavity = placed(sphere(), 0.5, {0.2, 0, 0});
  hollow.insert(hollow.end(), cavity.begin(), cavity.end());
  for (const auto& patches : {Torus(6).patches(false), Torus(5).patches(true), closed_body(), hollow}) {
    const WindingCase body(patches);
    ASSERT_TRUE(body.solid.is_closed());
    Random random(5);
    std::vector<Vec3> points;
    for (int k = 0; k < 3000; ++k) points.push_back(1.5 * uniform_vector(random, -1, 1));
    std::vector<double> numbers(points.size());
    std::vector<Containment> sides(points.size());
    ASSERT_TRUE(body.solid.winding_numbers(points, numbers).ok());
    ASSERT_TRUE(body.solid.contains(points, sides).ok());
    for (std::size_t k = 0; k < points.size(); ++k)
      EXPECT_NEAR(numbers[k], sides[k].side == PointSide::inside ? 1 : 0, 1e-9) << k;
  }
}

TEST(WindingNumbers, OfASphereWithASmallHole) {
  ModelSurface ball{.name = std::string("ball"), .surface = value_of(make_nurbs_sphere({}, 1))};
  ball.trims = std::vector<TrimLoop>{circle_loop(0.6, 0.1, 0.05, true)};
  const WindingCase open(one_surface(ball));
  EXPECT_GT(open.solid.open_borders(), 0u);
  const Vec3 hole = value_of(evaluate_jet(ball, 0.6, 0.1)).position;
  Random random(6);
  std::size_t inside = 0;
  for (int k = 0; k < 3000; ++k) {
    const Vec3 p = 1.4 * uniform_vector(random, -1, 1);
    if (length(p - hole) < 0.4) continue;
    const bool is_inside = length(p) < 1;
    EXPECT_EQ(open.solid.contains(p).side, is_inside ? PointSide::inside : PointSide::outside) << k;
    EXPECT_NEAR(open.at(p), is_inside ? 1 : 0, 0.2) << k;
    inside += is_inside;
  }
  EXPECT_GT(inside, 500u);
}

TEST(WindingNumbers, OfPatchesThatFaceAnyWay) {
  std::vector<BezierPatch> patches = Torus(6).patches(false);
  patches.erase(patches.begin() + 30, patches.end());
  std::vector<BezierPatch> mixed = patches;
  Random random(7);
  for (BezierPatch& patch : mixed)
    if (random() % 2 == 0) patch = turned(patch);
  const WindingCase one(patches), other(mixed);
  for (int k = 0; k < 500; ++k) {
    const Vec3 p = 1.5 * uniform_vector(random, -1, 1);
    EXPECT_NEAR(one.at(p), other.at(p), 1e-8) << k;
  }
  EXPECT_GT(one.at({1, 0, 0}), 0.5);
}

TEST(WindingNumbers, OfPointsThatAreFarOrWrong) {
  const WindingCase dome(hemisphere());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<Vec3> points{{nan, 0, 0},   {0, std::numeric_limits<double>::infinity(), 0},
                                 {1e300, 0, 0}, {1e9, 2e9, 1e9},
                                 {-1e17, 0, 1}, {1, 0, 0},
                                 {0, 0, 1},     {0, 0, 0}};
  std::vector<double> numbers(points.size());
  ASSERT_TRUE(dome.solid.winding_numbers(points, numbers).ok());
  for (std::size_t k = 0; k < 3; ++k) EXPECT_TRUE(std::isnan(numbers[k])) << k;
  EXPECT_NEAR(numbers[3], 0, 1e-12);
  EXPECT_NEAR(numbers[4], 0, 1e-12);
  // On the border, and on the surface, any number between those beside it.
  for (std::size_t k = 5; k < 7; ++k) EXPECT_LE(std::abs(numbers[k]), 1.5) << k;
  EXPECT_NEAR(numbers[7], 0.5, 1e-9);
  EXPECT_EQ(dome.solid.winding_numbers(points, std::span(numbers).first(2)).code(), StatusCode::buffer_too_small);
  EXPECT_TRUE(dome.solid.winding_numbers({}, {}).ok());
}

TEST(WindingNumbers, AreTheSameBytesForAnyNumberOfThreads) {
  std::vector<BezierPatch> patches = Torus(6).patches(false);
  patches.erase(patches.begin() + 30, patches.end());
  const WindingCase torn(patches);
  Random random(8);
  std::vector<Vec3> points;
  for (int k = 0; k < 2000; ++k) points.push_back(1.5 * uniform_vector(random, -1, 1));
  std::vector<double> one(points.size()), four(points.size());
  const tbb::global_control control(tbb::global_control::max_allowed_parallelism, 4);
  const auto run = [&](int threads, std::vector<double>& numbers) {
    tbb::task_arena(threads).execute([&] { EXPECT_TRUE(torn.solid.winding_numbers(points, numbers).ok()); });
  };
  run(1, one), run(4, four);
  EXPECT_EQ(std::memcmp(one.data(), four.data(), one.size() * sizeof(double)), 0);
}

TEST(WindingNumbers, SignDistances) {
  const WindingCase dome(hemisphere()), ball(sphere());
  const std::vector<Vec3> points{{0.3, 0, 0.4}, {0, 1.2, 1.6}, {0, 0.3, -0.4}, {0, 0, 0}};
  std::vector<SignedDistance> found(points.size());
  const PointScene near_dome = value_of(PointScene::make(dome.set)), near_ball = value_of(PointScene::make(ball.set));
  ASSERT_TRUE(signed_distances(dome.solid, near_dome, points, found).ok());
  EXPECT_NEAR(found[0].distance, -0.5, 1e-14);
  EXPECT_NEAR(found[1].distance, 1, 1e-14);
  EXPECT_NEAR(found[2].distance, std::sqrt(0.65), 1e-14);
  EXPECT_TRUE(std::isnan(found[3].distance));
  EXPECT_EQ(found[3].side, PointSide::unknown);
  for (const SignedDistance& one : found) EXPECT_FALSE(one.is_side_certified);
  EXPECT_TRUE(found[0].is_nearest_certified);
  ASSERT_TRUE(signed_distances(ball.solid, near_ball, points, found).ok());
  EXPECT_NEAR(found[2].distance, -0.5, 1e-14);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_TRUE(found[k].is_side_certified && found[k].is_nearest_certified) << k;
  EXPECT_EQ(signed_distances(ball.solid, near_ball, points, std::span(found).first(1)).code(),
            StatusCode::buffer_too_small);
}

}}  // namespace tessera::test
