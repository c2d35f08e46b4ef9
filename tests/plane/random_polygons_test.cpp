// Triangles of random polygons beside brute force in integers.

#include "plane/plane_reference.h"

namespace tessera::test { namespace {

Triangles copy_of(PolygonTriangles& sweep) { return {sweep.triangles().begin(), sweep.triangles().end()}; }

// Stars in the cells of a plate, every second with an island, up to 100 holes.
TEST(RandomPolygons, CoverEachPointAsOftenAsTheirParitySays) {
  std::mt19937_64 random(11);
  PolygonTriangles sweep;
  int inside = 0, outside = 0;
  for (int round = 0; round < 60; ++round) {
    const int n = 1 + round % 10;
    const double size = 1e8, cell = size / n;
    Points points;
    std::vector<std::uint32_t> ends;
    add_star(points, ends, random, {size / 2, size / 2}, 0.8 * size, size, 3 + round);
    for (int k = 0; k < n * n; ++k) {
      const ParameterPoint centre{cell * (k % n + 0.5), cell * (k / n + 0.5)};
      const int count = 3 + static_cast<int>(below(random, 30));
      add_star(points, ends, random, centre, 0.3 * cell, 0.49 * cell, count, random() % 2);
      if (k % 2) add_star(points, ends, random, centre, 0.01 * cell, 0.14 * cell, count, random() % 2);
    }
    const PlaneSegments borders = segments_of(ends);
    bool cross = false;
    for (std::size_t a = 0; a < borders.size() && n < 4; ++a)
      for (std::size_t b = 0; b < a; ++b) cross = cross || crosses(points, borders[a], borders[b]);
    const bool ok = sweep.run_rings(points, ends);
    if (n < 4) {
      ASSERT_EQ(ok, !cross);
    }
    if (!ok) continue;
    const Triangles triangles = copy_of(sweep);
    ASSERT_EQ(fault_of(points, triangles, borders), "");
    std::uniform_real_distribution<double> place(-0.5 * size, 1.5 * size);
    for (int k = 0; k < 200; ++k) {
      const ParameterPoint p{std::round(place(random)), std::round(place(random))};
      bool on_edge = false;
      for (const auto& t : triangles)
        for (std::size_t e = 0; e < 3; ++e) on_edge = on_edge || is_on(p, points[t[e]], points[t[(e + 1) % 3]]);
      if (on_edge) continue;
      const bool wanted = is_inside(p, points, borders);
      (wanted ? inside : outside) += 1;
      ASSERT_EQ(cover(points, triangles, p), wanted ? 1 : 0);
    }
  }
  EXPECT_GT(inside, 1000);
  EXPECT_GT(outside, 1000);
}

// A soup of the sides of some triangles of a triangulation. What two of them share drops out, and all else touches.
TEST(RandomPolygons, OfTriangleSoupsHaveTheirArea) {
  std::mt19937 random(5);
  PolygonTriangles sweep;
  for (int round = 0; round < 300; ++round) {
    const std::uint32_t n = 1 + below(random, 12);
    const auto moved = [&](std::uint32_t k) { return double(40 * k + (random() % 2 ? below(random, 19) : 9)); };
    Points points;
    for (std::uint32_t i = 0; i <= n; ++i)
      for (std::uint32_t j = 0; j <= n; ++j)  // moved by less than a quarter of a cell, half of them on the lattice
        points.push_back({moved(i), moved(j)});
    PlaneSegments borders;
    Wide area = 0;
    for (std::uint32_t i = 0; i < n; ++i) {
      for (std::uint32_t j = 0; j < n; ++j) {
        const std::uint32_t a = i * (n + 1) + j, b = a + n + 1, c = b + 1, d = a + 1;
        for (const auto& [x, y, z] : {std::array{a, b, c}, std::array{a, c, d}}) {
          if (random() % 3 == 0) continue;
          ASSERT_GT(side(points[x], points[y], points[z]), 0);
          area += twice_area(points[x], points[y], points[z]);
          for (const PlaneSegment border : {PlaneSegment{x, y}, {y, z}, {z, x}}) borders.push_back(border);
        }
      }
    }
    ASSERT_TRUE(sweep.run(points, borders));
    const Triangles triangles = copy_of(sweep);
    ASSERT_EQ(surface_of(points, triangles).fault, "");
    ASSERT_TRUE(twice_area(points, triangles) == area);
  }
}

/// Whether some borders cross where no point is.
bool cross_freely(const Points& points, const PlaneSegments& borders) {
  for (std::size_t a = 0; a < borders.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      if (!crosses(points, borders[a], borders[b])) continue;
      if (std::ranges::none_of(points, [&](const ParameterPoint& p) {
            return is_on(p, points[borders[a].start], points[borders[a].end]) &&
                   is_on(p, points[borders[b].start], points[borders[b].end]);
          }))
        return true;
    }
  }
  return false;
}
/// Whether a part of a segment belongs to another one too.
bool overlaps(const Points& points, const PlaneSegments& borders, std::size_t k) {
  int count = 0;
  const ParameterPoint &a = points[borders[k].start], &b = points[borders[k].end];
  for (const auto& [start, end] : borders)
    count += side(a, b, points[start]) == 0 && side(a, b, points[end]) == 0 && !(points[start] == points[end]);
  return count > 1;
}

// Small integers: repeated points, points on segments, overlaps and crossings in most of the soups.
TEST(RandomPolygons, OfSmallIntegersAreRefusedIfAndOnlyIfTheyCross) {
  std::mt19937 random(9);
  PolygonTriangles sweep;
  int refused = 0, done = 0;
  for (int round = 0; round < 30000; ++round) {
    const std::uint32_t size = 2 + below(random, 12);
    Points points;
    std::vector<std::uint32_t> ends;
    for (unsigned ring = 0; ring <= random() % 4; ++ring) {
      for (unsigned k = 0; k <= random() % 9; ++k)
        points.push_back({double(below(random, size)), double(below(random, size))});
      ends.push_back(static_cast<std::uint32_t>(points.size()));
    }
    const PlaneSegments borders = segments_of(ends);
    const bool ok = sweep.run_rings(points, ends);
    if (cross_freely(points, borders)) {
      refused += !ok;
      if (!ok) continue;
      bool is_excused = false;  // crossings of parts that drop out do not count
      for (std::size_t k = 0; k < borders.size(); ++k) is_excused = is_excused || overlaps(points, borders, k);
      ASSERT_TRUE(is_excused) << round;
      continue;
    }
    ASSERT_TRUE(ok) << round;
    ++done;
    const Triangles triangles = copy_of(sweep);
    ASSERT_EQ(surface_of(points, triangles).fault, "") << round;
    Points fine = points;
    for (ParameterPoint& p : fine) p = {42 * p.u, 42 * p.v};
    for (const auto& [a, b, c] : triangles) {
      const ParameterPoint centre{(fine[a].u + fine[b].u + fine[c].u) / 3, (fine[a].v + fine[b].v + fine[c].v) / 3};
      ASSERT_TRUE(is_inside(centre, fine, borders)) << round;
      for (const ParameterPoint& p : points) {
        const int x = side(points[a], points[b], p), y = side(points[b], points[c], p),
                  z = side(points[c], points[a], p);
        ASSERT_FALSE(x >= 0 && y >= 0 && z >= 0 && x + y + z > 1) << round << ": a point in a triangle or on its edge";
      }
    }
    for (int k = 0; k < 30; ++k) {
      const ParameterPoint p{double(below(random, 42 * size)), double(below(random, 42 * size))};
      const auto is_on_segment = [&](PlaneSegment s) { return is_on(p, fine[s.start], fine[s.end]); };
      if (std::ranges::any_of(borders, is_on_segment)) continue;
      bool on_edge = false;
      for (const auto& [a, b, c] : triangles)
        on_edge = on_edge || is_on(p, fine[a], fine[b]) || is_on(p, fine[b], fine[c]) || is_on(p, fine[c], fine[a]);
      if (on_edge) continue;
      ASSERT_EQ(cover(fine, triangles, p), is_inside(p, fine, borders) ? 1 : 0) << round;
    }
  }
  EXPECT_GT(refused, 5000);
  EXPECT_GT(done, 5000);
}

}}  // namespace tessera::test
