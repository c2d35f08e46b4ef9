// Triangles of polygons: closed forms, and the cases that the contract defines.

#include "plane/polygon_triangles.h"

#include "plane/plane_reference.h"

namespace tessera::test { namespace {

struct Triangulated {
  bool ok;
  Triangles triangles;
};
Triangulated triangulate(const Points& points, const PlaneSegments& borders, const PlaneSegments& cuts = {}) {
  PolygonTriangles sweep;
  const bool ok = sweep.run(points, borders, cuts);
  return {ok, {sweep.triangles().begin(), sweep.triangles().end()}};
}
Triangulated triangulate_rings(const Points& points, const std::vector<std::uint32_t>& ends) {
  PolygonTriangles sweep;
  const bool ok = sweep.run_rings(points, ends);
  return {ok, {sweep.triangles().begin(), sweep.triangles().end()}};
}
const Points square{{0, 0}, {8, 0}, {8, 8}, {0, 8}};
Points with_square(const Points& more) {
  Points points = square;
  points.insert(points.end(), more.begin(), more.end());
  return points;
}

TEST(PolygonTriangles, OfASquareAreTwo) {
  const auto [ok, triangles] = triangulate_rings(square, {4});
  ASSERT_TRUE(ok);
  EXPECT_EQ(triangles.size(), 2u);
  EXPECT_EQ(fault_of(square, triangles, segments_of(std::vector{4u})), "");
  EXPECT_TRUE(twice_area(square, triangles) == 128);
}

TEST(PolygonTriangles, OfAnEmptyInputAreNone) {
  EXPECT_TRUE(triangulate({}, {}).ok);
  EXPECT_TRUE(triangulate({{1, 1}}, {}).triangles.empty());
  const auto [ok, triangles] = triangulate_rings({{0, 0}, {3, 5}}, {2});
  EXPECT_TRUE(ok);  // there and back again
  EXPECT_TRUE(triangles.empty());
}

// A plate with n x n round holes: as many triangles as Euler's formula says, points - 2 + 2 holes.
TEST(PolygonTriangles, OfADrilledPlateHaveItsArea) {
  for (const int n : {1, 3, 8, 10}) {
    const double size = 1e6 * n;
    Points points{{0, 0}, {size, 0}, {size, size}, {0, size}};
    std::vector<std::uint32_t> ends{4};
    std::mt19937 random(1);
    for (int k = 0; k < n * n; ++k)
      add_star(points, ends, random, {1e6 * (k % n) + 5e5, 1e6 * (k / n) + 5e5}, 3e5, 3e5, 24, true);
    const auto [ok, triangles] = triangulate_rings(points, ends);
    ASSERT_TRUE(ok);
    const PlaneSegments borders = segments_of(ends);
    EXPECT_EQ(fault_of(points, triangles, borders), "");
    EXPECT_EQ(triangles.size(), points.size() - 2 + 2 * static_cast<std::size_t>(n * n));
    EXPECT_TRUE(twice_area(points, triangles) == twice_enclosed(points, borders));
  }
}

TEST(PolygonTriangles, DoNotDependOnOrderAndDirection) {
  Points points{{0, 0}, {1e6, 0}, {1e6, 1e6}, {0, 1e6}};
  std::vector<std::uint32_t> ends{4};
  std::mt19937 random(7);
  for (int k = 0; k < 9; ++k)
    add_star(points, ends, random, {2e5 + 3e5 * (k % 3), 2e5 + 3e5 * (k / 3)}, 5e4, 1.4e5, 30);
  PlaneSegments borders = segments_of(ends);
  const auto sorted = [](Triangles triangles) {
    for (auto& t : triangles) std::ranges::rotate(t, std::ranges::min_element(t));
    std::ranges::sort(triangles);
    return triangles;
  };
  const Triangulated first = triangulate(points, borders);
  ASSERT_TRUE(first.ok);
  for (int k = 0; k < 20; ++k) {
    std::ranges::shuffle(borders, random);
    for (PlaneSegment& border : borders)
      if (random() % 2) std::swap(border.start, border.end);
    EXPECT_EQ(sorted(triangulate(points, borders).triangles), sorted(first.triangles));
  }
}

TEST(PolygonTriangles, TakeRepeatedPointsForTheFirst) {
  const Points points{{0, 0}, {0, 0}, {8, 0}, {8, 8}, {8, 8}, {8, 8}, {0, 8}, {0, 0}};
  const auto [ok, triangles] = triangulate_rings(points, {8});
  ASSERT_TRUE(ok);
  EXPECT_EQ(fault_of(points, triangles, {{0, 2}, {2, 3}, {3, 6}, {6, 0}}), "");
  EXPECT_TRUE(twice_area(points, triangles) == 128);
}

TEST(PolygonTriangles, HavePointsOnALineAsCorners) {
  const Points points{{0, 0}, {2, 0}, {5, 0}, {8, 0}, {8, 8}, {6, 8}, {1, 8}, {0, 8}, {0, 4}};
  const auto [ok, triangles] = triangulate_rings(points, {9});
  ASSERT_TRUE(ok);
  EXPECT_EQ(triangles.size(), 7u);
  EXPECT_EQ(fault_of(points, triangles, segments_of(std::vector{9u})), "");
}

TEST(PolygonTriangles, AreDividedWhereHolesTouch) {
  // A corner of the hole lies on the border, another on a corner of a second hole.
  const Points points = with_square({{0, 4}, {2, 3}, {4, 4}, {2, 5}, {4, 4}, {6, 3}, {6, 5}});
  const auto [ok, triangles] = triangulate_rings(points, {4, 8, 11});
  ASSERT_TRUE(ok);
  EXPECT_EQ(
      fault_of(points, triangles,
               {{0, 1}, {1, 2}, {2, 3}, {3, 4}, {4, 0}, {4, 5}, {5, 6}, {6, 7}, {7, 4}, {6, 9}, {9, 10}, {10, 6}}),
      "");
  EXPECT_TRUE(twice_area(points, triangles) == 128 - 8 - 4);
}

TEST(PolygonTriangles, IgnoreSlits) {
  const Points points = with_square({{2, 2}, {6, 5}, {4, 0}});
  PlaneSegments borders = segments_of(std::vector{4u});
  for (const PlaneSegment slit : {PlaneSegment{4, 5}, {5, 4}, {4, 6}, {6, 4}}) borders.push_back(slit);
  const auto [ok, triangles] = triangulate(points, borders);
  ASSERT_TRUE(ok);
  EXPECT_EQ(surface_of(points, triangles).fault, "");
  EXPECT_TRUE(twice_area(points, triangles) == 128);
}

TEST(PolygonTriangles, DropWhatBordersShare) {
  // Two rectangles side by side; their common border is longer on one side.
  const Points points{{0, 0}, {4, 0}, {4, 8}, {0, 8}, {4, 2}, {8, 2}, {8, 6}, {4, 6}};
  const auto [ok, triangles] = triangulate_rings(points, {4, 8});
  ASSERT_TRUE(ok);
  EXPECT_EQ(fault_of(points, triangles, {{0, 1}, {1, 4}, {4, 5}, {5, 6}, {6, 7}, {7, 2}, {2, 3}, {3, 0}}), "");
  EXPECT_TRUE(twice_area(points, triangles) == 64 + 32);
}

TEST(PolygonTriangles, HaveCutsAsEdges) {
  const Points points = with_square({{4, 4}, {6, 2}, {20, 20}});
  const PlaneSegments cuts{{0, 4}, {4, 5}, {1, 3}, {2, 6}};  // the third runs through point 4, the fourth lies outside
  const auto [ok, triangles] = triangulate(points, segments_of(std::vector{4u}), cuts);
  ASSERT_TRUE(ok);
  EXPECT_EQ(fault_of(points, triangles, segments_of(std::vector{4u})), "");
  for (const auto [start, end] : {PlaneSegment{0, 4}, {4, 5}, {1, 5}, {3, 4}}) {
    bool found = false;
    for (const auto& t : triangles)
      found = found || (std::ranges::count(t, start) == 1 && std::ranges::count(t, end) == 1);
    EXPECT_TRUE(found) << start << " - " << end;
  }
}

TEST(PolygonTriangles, HaveFreePointsAsCorners) {
  Points points = square;
  std::mt19937 random(3);
  for (int k = 0; k < 40; ++k) points.push_back({double(below(random, 9)), double(below(random, 9))});
  points.push_back({20, 20});
  const auto [ok, triangles] = triangulate(points, segments_of(std::vector{4u}));
  ASSERT_TRUE(ok);
  EXPECT_EQ(surface_of(points, triangles).fault, "");
  EXPECT_TRUE(twice_area(points, triangles) == 128);
  for (const ParameterPoint& point : points) {
    bool is_corner = false;
    for (const auto& t : triangles)
      for (const std::uint32_t k : t) is_corner = is_corner || points[k] == point;
    EXPECT_EQ(is_corner, point.u < 10);
  }
}

TEST(PolygonTriangles, KeepLoopsAUnitInTheLastPlaceApart) {
  Points points{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  for (const auto [u, v] : square) {
    const auto beside = [](double x) { return x == 0 ? 0x1p-60 : std::nextafter(1.0, 0.0); };
    points.push_back({beside(u), beside(v)});
  }
  const auto [ok, triangles] = triangulate_rings(points, {4, 8});
  ASSERT_TRUE(ok);
  EXPECT_EQ(triangles.size(), 8u);
  for (const auto& t : triangles) EXPECT_GT(exact_orientation(points[t[0]], points[t[1]], points[t[2]]), 0);
}

TEST(PolygonTriangles, OfCrossingBordersAreRefused) {
  const Points bow_tie{{0, 0}, {8, 8}, {8, 0}, {0, 8}};
  EXPECT_FALSE(triangulate_rings(bow_tie, {4}).ok);
  EXPECT_TRUE(triangulate_rings(bow_tie, {4}).triangles.empty());
  const Points plus{{0, 3}, {8, 3}, {8, 5}, {0, 5}, {3, 0}, {5, 0}, {5, 8}, {3, 8}};
  EXPECT_FALSE(triangulate_rings(plus, {4, 8}).ok);
  EXPECT_FALSE(triangulate(square, segments_of(std::vector{4u}), {{0, 2}, {1, 3}}).ok) << "cuts cross";
}

TEST(PolygonTriangles, OfOpenBordersAreRefused) {
  EXPECT_FALSE(triangulate(square, {{0, 1}, {1, 2}, {2, 3}}).ok);
  EXPECT_FALSE(triangulate(square, {{0, 1}}).ok);
}

// The faults that the checker of these tests must find.
TEST(PolygonTriangles, CheckerFindsPlantedFaults) {
  Points points = square;
  std::vector<std::uint32_t> ends{4};
  std::mt19937 random(5);
  add_star(points, ends, random, {4, 4}, 3, 3, 8);
  const PlaneSegments borders = segments_of(ends);
  const auto [ok, good] = triangulate_rings(points, ends);
  ASSERT_TRUE(ok);
  ASSERT_EQ(fault_of(points, good, borders), "");
  Triangles bad = good;
  bad.pop_back();
  EXPECT_NE(fault_of(points, bad, borders), "");
  bad = good;
  bad.push_back(good[0]);
  EXPECT_NE(fault_of(points, bad, borders), "");
  bad = good;
  std::swap(bad[0][0], bad[0][1]);
  EXPECT_NE(fault_of(points, bad, borders), "");
  for (std::uint32_t k = 0; k < points.size(); ++k) {
    bad = good;
    if (std::ranges::count(bad[1], k)) continue;
    bad[1][2] = k;
    EXPECT_NE(fault_of(points, bad, borders), "");
  }
}

}}  // namespace tessera::test
