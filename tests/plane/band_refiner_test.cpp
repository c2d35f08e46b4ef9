// Halving of large triangles: it ends, keeps triangles joined, and leaves none that it could make smaller.

#include "plane/band_refiner.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "plane/plane_reference.h"

namespace tessera::test { namespace {

/// Triangles are large if they are wider than 1 / a or higher than 1 / b.
struct Limits {
  double a = 1, b = 1;
  std::uint64_t max_triangles = 1u << 20;
};

struct Box {
  double width, height;
};
template <std::size_t count>
Box box_of(const Points& points, const std::array<std::uint32_t, count>& corners) {
  const auto [u0, u1] = std::ranges::minmax(corners, {}, [&](std::uint32_t k) { return points[k].u; });
  const auto [v0, v1] = std::ranges::minmax(corners, {}, [&](std::uint32_t k) { return points[k].v; });
  return {points[u1].u - points[u0].u, points[v1].v - points[v0].v};
}

bool is_large(const Points& points, const std::array<std::uint32_t, 3>& triangle, const Limits& limits) {
  const Box box = box_of(points, triangle);
  return box.width * limits.a > 1 || box.height * limits.b > 1;
}

bool refine(Points& points, Triangles& triangles, const Limits& limits, const std::atomic<bool>* cancel = nullptr) {
  const auto large = [&](const BandRefiner::Triangle& triangle) { return is_large(points, triangle, limits); };
  const auto length = [&](std::uint32_t a, std::uint32_t b) {
    const Box box = box_of(points, std::array{a, b});
    return std::hypot(box.width * limits.a, box.height * limits.b);
  };
  const auto middle = [&](std::uint32_t a, std::uint32_t b, std::uint32_t, std::uint32_t) {
    return ParameterPoint{(points[a].u + points[b].u) / 2, (points[a].v + points[b].v) / 2};
  };
  return BandRefiner().run(points, triangles, 0, {large, length, middle, limits.max_triangles, cancel});
}

// A large triangle whose longest edge has no second triangle, and neighbours whose longest edges are its others: their
// halves lead to ever flatter triangles along that edge, unless a triangle's own longest edge is halved first.
TEST(BandRefiner, EndsBesideALongEdgeWithOneTriangle) {
  for (const double height : {0.25, 1e-3, 1e-9}) {
    Points points{{0, 0}, {1, 0}, {0.375, height}, {0, 1}, {1, 1}};
    Triangles triangles{{0, 1, 2}, {0, 2, 3}, {2, 1, 4}, {2, 4, 3}};
    ASSERT_TRUE(refine(points, triangles, {8, 8, 4000}));
    EXPECT_EQ(surface_of(points, triangles).open.size(), 4u);
  }
}

// Random triangulations with all sorts of needles, at limits of very uneven directions, or of one direction alone.
TEST(BandRefiner, OfRandomPolygonsEnds) {
  std::mt19937_64 random(3);
  PolygonTriangles sweep;
  std::size_t divided = 0;
  for (int round = 0; round < 400; ++round) {
    Points points;
    std::vector<std::uint32_t> ends;
    add_star(points, ends, random, {5e5, 5e5}, 1e5, 5e5, 3 + round % 40);
    if (round % 2) add_star(points, ends, random, {5e5, 5e5}, 1e3, 9e4, 3 + round % 7, true);
    const double flat = std::pow(10.0, -double(round % 5));
    for (ParameterPoint& p : points) p = {std::round(p.u), std::round(p.v * flat)};
    if (!sweep.run_rings(points, ends)) continue;
    Triangles triangles{sweep.triangles().begin(), sweep.triangles().end()};
    const std::size_t before = triangles.size();
    const Surface outline = surface_of(points, triangles);
    const auto area = [&] {
      double sum = 0;
      for (const auto& [a, b, c] : triangles)
        sum += (points[b].u - points[a].u) * (points[c].v - points[a].v) -
               (points[b].v - points[a].v) * (points[c].u - points[a].u);
      return sum;
    };
    const double whole = area();
    const double fine = std::pow(2.0, 1 + round % 5) / 1e6;
    Limits limits{fine, fine / flat};
    if (round % 3 == 1) limits.a = 0;
    if (round % 3 == 2) limits.b = 0;
    ASSERT_TRUE(refine(points, triangles, limits)) << round;
    divided += triangles.size() - before;
    EXPECT_EQ(surface_of(points, triangles).open, outline.open) << round;
    EXPECT_NEAR(area(), whole, 1e-9 * whole) << round;
  }
  EXPECT_GT(divided, 10000u);
}

/// A square whose sides are divided into `count` parts each, as triangles around its middle.
void make_square(int count, Points& points, Triangles& triangles) {
  for (const auto& [u, v, du, dv] : {std::array{0, 0, 1, 0}, {1, 0, 0, 1}, {1, 1, -1, 0}, {0, 1, 0, -1}})
    for (int k = 0; k < count; ++k) points.push_back({u + du * double(k) / count, v + dv * double(k) / count});
  const auto middle = static_cast<std::uint32_t>(points.size());
  points.push_back({0.5, 0.5});
  for (std::uint32_t k = 0; k < middle; ++k) triangles.push_back({k, (k + 1) % middle, middle});
}

// Where the outline's edges are no longer than what is allowed, no large triangle is left.
TEST(BandRefiner, LeavesNoLargeTriangleWithinAFineOutline) {
  for (const int count : {4, 16, 64}) {
    Points points;
    Triangles triangles;
    make_square(count, points, triangles);
    const Limits limits{double(count), double(count)};
    ASSERT_TRUE(refine(points, triangles, limits));
    EXPECT_EQ(std::ranges::count_if(triangles, [&](const auto& t) { return is_large(points, t, limits); }), 0);
    EXPECT_EQ(surface_of(points, triangles).open.size(), static_cast<std::size_t>(4 * count));
    EXPECT_GE(triangles.size(), static_cast<std::size_t>(2 * count * count));
  }
}

TEST(BandRefiner, StopsAtItsLimit) {
  Points points;
  Triangles triangles;
  make_square(64, points, triangles);
  EXPECT_FALSE(refine(points, triangles, {64, 64, 1000}));
  EXPECT_LE(triangles.size(), 1000u);
  EXPECT_EQ(surface_of(points, triangles).open.size(), 256u);
}

TEST(BandRefiner, StopsWhenCancelled) {
  Points points;
  Triangles triangles;
  make_square(64, points, triangles);
  const std::atomic<bool> cancel = true;
  EXPECT_TRUE(refine(points, triangles, {64, 64}, &cancel));
  EXPECT_EQ(triangles.size(), 256u);
}

}}  // namespace tessera::test
