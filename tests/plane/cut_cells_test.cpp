// Cells that loops cut, beside brute force in integers.

#include "plane/cut_cells.h"

#include "plane/plane_reference.h"

namespace tessera::test { namespace {

/// A grid of integers, and loops in it.
struct Loops {
  std::vector<double> u, v;
  Points points;
  std::vector<std::uint32_t> ends;

  GridLines grid() const { return {u, v}; }
  /// Ends a ring.
  void close() { ends.push_back(static_cast<std::uint32_t>(points.size())); }
  /// Adds the rectangle of the grid as a loop, with the grid's points on its sides.
  void add_rectangle() {
    for (std::size_t i = 0; i + 1 < u.size(); ++i) points.push_back({u[i], v.front()});
    for (std::size_t j = 0; j + 1 < v.size(); ++j) points.push_back({u.back(), v[j]});
    for (std::size_t i = u.size() - 1; i > 0; --i) points.push_back({u[i], v.back()});
    for (std::size_t j = v.size() - 1; j > 0; --j) points.push_back({u.front(), v[j]});
    close();
  }
};
Loops even_grid(int cells_u, int cells_v, double size = 1000) {
  Loops loops;
  for (int i = 0; i <= cells_u; ++i) loops.u.push_back(size * i);
  for (int j = 0; j <= cells_v; ++j) loops.v.push_back(size * j);
  return loops;
}

/// The cells and triangles that CutCells made of loops.
struct Cut {
  bool ok = false;
  Points points;  // of the loops, then of the grid
  Triangles triangles, band;
  std::vector<CellUse> uses;
};
Cut cut(const Loops& loops) {
  CutCells cells;
  Cut result;
  const GridLines grid = loops.grid();
  result.ok = cells.run(grid, loops.points, segments_of(loops.ends));
  result.points = loops.points;
  for (const std::uint32_t vertex : cells.grid_vertices())
    result.points.push_back(grid.point(grid.place_of_vertex(vertex)));
  result.band.assign(cells.band().begin(), cells.band().end());
  result.triangles = result.band;
  result.uses.assign(cells.uses().begin(), cells.uses().end());
  if (!result.ok) return result;
  std::size_t whole = 0;
  cells.for_whole(
      [&](std::uint32_t i, std::uint32_t j, std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
        ++whole;
        EXPECT_EQ(result.points[a], grid.point({i, j}));
        EXPECT_EQ(result.points[c], grid.point({i + 1, j + 1}));
        result.triangles.push_back({a, b, c});
        result.triangles.push_back({a, c, d});
      });
  EXPECT_EQ(whole, cells.whole_count());
  return result;
}

/// Expects that the triangles fit together without T-junctions, and that their open edges are the chords, each once.
void expect_sound(const Loops& loops, const Cut& result) {
  ASSERT_TRUE(result.ok);
  const PlaneSegments chords = segments_of(loops.ends);
  EXPECT_EQ(fault_of(result.points, result.triangles, chords), "");
  for (std::size_t k = loops.points.size(); k < result.points.size(); ++k) {
    for (const auto& [start, end] : chords)
      ASSERT_FALSE(is_on(result.points[k], loops.points[start], loops.points[end])) << "a grid vertex on a chord";
  }
}

/// The largest width of a triangle of the band, in cells of an even grid.
double widest(const Cut& result, double size) {
  double most = 0;
  for (const auto& [a, b, c] : result.band) {
    const auto [u0, u1] = std::minmax({result.points[a].u, result.points[b].u, result.points[c].u});
    const auto [v0, v1] = std::minmax({result.points[a].v, result.points[b].v, result.points[c].v});
    most = std::max({most, (u1 - u0) / size, (v1 - v0) / size});
  }
  return most;
}

TEST(CutCells, OfTheWholeRectangleAreAllWhole) {
  Loops loops = even_grid(5, 3);
  loops.add_rectangle();
  const Cut result = cut(loops);
  expect_sound(loops, result);
  EXPECT_TRUE(result.band.empty());
  EXPECT_EQ(result.triangles.size(), 30u);
}

TEST(CutCells, WithoutLoopsAreAllLeftOut) {
  const Cut result = cut(even_grid(5, 3));
  ASSERT_TRUE(result.ok);
  EXPECT_TRUE(result.triangles.empty());
}

TEST(CutCells, OfARoundHoleLeaveOutItsMiddle) {
  Loops loops = even_grid(16, 16);
  loops.add_rectangle();
  std::mt19937 random(1);
  add_star(loops.points, loops.ends, random, {8100, 7900}, 5300, 5300, 60, true);
  const Cut result = cut(loops);
  expect_sound(loops, result);
  EXPECT_TRUE(twice_area(result.points, result.triangles) == twice_enclosed(loops.points, segments_of(loops.ends)));
  EXPECT_EQ(result.uses[8 * 16 + 8], CellUse::out);
  EXPECT_EQ(result.uses[0], CellUse::whole);
  EXPECT_LT(widest(result, 1000), 1.6);
}

// A loop along lines of the grid cuts no cell; one beside them does.
TEST(CutCells, AreNotCutByTheirOwnSides) {
  Loops loops = even_grid(8, 8);
  for (const ParameterPoint p :
       {ParameterPoint{2, 2}, {3, 2}, {4, 2}, {4, 3}, {5, 3}, {5, 4}, {4, 4}, {3, 4}, {2, 4}, {2, 3}})
    loops.points.push_back({1000 * p.u, 1000 * p.v});
  loops.close();
  const Cut result = cut(loops);
  expect_sound(loops, result);
  EXPECT_TRUE(result.band.empty());
  EXPECT_EQ(result.triangles.size(), 10u);
  for (ParameterPoint& p : loops.points) p.u += 1;
  const Cut beside = cut(loops);
  expect_sound(loops, beside);
  EXPECT_FALSE(beside.band.empty());
  EXPECT_TRUE(twice_area(beside.points, beside.triangles) == twice_area(result.points, result.triangles));
}

// A side divided otherwise than the grid: the cells beside it join both divisions.
TEST(CutCells, JoinSidesOfAnotherDivision) {
  for (const int division : {1, 2, 3, 7, 8, 9, 40}) {
    Loops loops = even_grid(8, 8, 840 * 9);
    for (int side = 0; side < 4; ++side) {
      for (int k = 0; k < division; ++k) {
        const double t = 8.0 * 840 * 9 * k / division, end = 8.0 * 840 * 9;
        const ParameterPoint at[4] = {{t, 0}, {end, t}, {end - t, end}, {0, end - t}};
        loops.points.push_back({std::round(at[side].u), std::round(at[side].v)});
      }
    }
    loops.close();
    const Cut result = cut(loops);
    expect_sound(loops, result);
    EXPECT_EQ(result.band.empty(), division == 8);
    EXPECT_LE(widest(result, 840 * 9), std::max(2.0, 8.0 / division + 1)) << division;
  }
}

/// Whether a chord comes into a cell with its sides.
bool meets(const GridLines& grid, std::uint32_t i, std::uint32_t j, const ParameterPoint& a, const ParameterPoint& b) {
  if (std::max(a.u, b.u) < grid.u(i) || std::min(a.u, b.u) > grid.u(i + 1)) return false;
  if (std::max(a.v, b.v) < grid.v(j) || std::min(a.v, b.v) > grid.v(j + 1)) return false;
  int left = 0, right = 0;
  for (const GridPlace corner : {GridPlace{i, j}, {i + 1, j}, {i, j + 1}, {i + 1, j + 1}}) {
    left += side(a, b, grid.point(corner)) > 0;
    right += side(a, b, grid.point(corner)) < 0;
  }
  return left < 4 && right < 4;
}

void expect_uses(const Loops& loops, const Cut& result) {
  const GridLines grid = loops.grid();
  const PlaneSegments chords = segments_of(loops.ends);
  for (std::uint32_t i = 0; i < grid.columns(); ++i) {
    for (std::uint32_t j = 0; j < grid.rows(); ++j) {
      const CellUse use = result.uses[grid.cell(i, j)];
      if (use == CellUse::cut) continue;
      for (const auto& [start, end] : chords)
        ASSERT_FALSE(meets(grid, i, j, loops.points[start], loops.points[end])) << i << ", " << j;
      const ParameterPoint middle{std::floor((grid.u(i) + grid.u(i + 1)) / 2),
                                  std::floor((grid.v(j) + grid.v(j + 1)) / 2)};
      ASSERT_EQ(use == CellUse::whole, is_inside(middle, loops.points, chords)) << i << ", " << j;
    }
  }
}

// Up to 100 loops on grids whose lines are even, or have cells of two sizes, or of all sizes.
TEST(CutCells, OfRandomLoopsFitTheirChords) {
  std::mt19937 random(21);
  int cut_cells = 0, whole_cells = 0;
  for (int round = 0; round < 120; ++round) {
    Loops loops;
    for (std::vector<double>* lines : {&loops.u, &loops.v}) {
      lines->push_back(0);
      const std::uint32_t kind = below(random, 3), count = 8 + below(random, 40);
      for (std::uint32_t k = 0; k < count; ++k)
        lines->push_back(lines->back() + (kind == 0   ? 10000
                                          : kind == 1 ? (k < count / 2 ? 5000 : 15000)
                                                      : 1000 + below(random, 20000)));
    }
    const int n = 1 + round % 10;
    const double cell = std::min(loops.u.back(), loops.v.back()) / n;
    for (int k = 0; k < n * n; ++k) {
      const ParameterPoint centre{cell * (k % n + 0.5), cell * (k / n + 0.5)};
      add_star(loops.points, loops.ends, random, centre, 0.35 * cell, 0.49 * cell,
               3 + static_cast<int>(below(random, 60)));
      if (k % 3 == 0) add_star(loops.points, loops.ends, random, centre, 0.01 * cell, 0.15 * cell, 12, true);
    }
    const Cut result = cut(loops);
    expect_sound(loops, result);
    expect_uses(loops, result);
    ASSERT_FALSE(HasFailure()) << round;
    for (const CellUse use : result.uses) cut_cells += use == CellUse::cut, whole_cells += use == CellUse::whole;
  }
  EXPECT_GT(cut_cells, 10000);
  EXPECT_GT(whole_cells, 2000);
}

// Points of loops on lines and vertices of the grid, chords through vertices, chords as long as the grid.
TEST(CutCells, OfLatticeLoopsFitTheirChords) {
  std::mt19937 random(22);
  int done = 0;
  for (int round = 0; round < 4000; ++round) {
    const double step = round % 2 ? 1000 : 500;
    Loops loops = even_grid(6, 6);
    const std::uint32_t size = static_cast<std::uint32_t>(6000 / step) + 1;
    for (std::uint32_t ring = 0; ring <= below(random, 3); ++ring) {
      for (std::uint32_t k = 0; k < 3 + below(random, 4); ++k)
        loops.points.push_back({step * below(random, size), step * below(random, size)});
      loops.close();
    }
    const PlaneSegments chords = segments_of(loops.ends);
    bool is_simple = true;  // no chord touches, crosses or overlaps another one but at their common end
    for (const auto& [start, end] : chords)
      for (std::uint32_t k = 0; k < loops.points.size(); ++k)
        if (k != start && k != end && is_on(loops.points[k], loops.points[start], loops.points[end])) is_simple = false;
    for (std::size_t a = 0; a < chords.size(); ++a)
      for (std::size_t b = 0; b < a; ++b) is_simple = is_simple && !crosses(loops.points, chords[a], chords[b]);
    for (std::size_t a = 0; a < chords.size(); ++a)
      is_simple = is_simple && !(loops.points[chords[a].start] == loops.points[chords[a].end]);
    if (!is_simple) continue;
    const Cut result = cut(loops);
    ASSERT_TRUE(result.ok) << round;
    ASSERT_EQ(surface_of(result.points, result.triangles).fault, "") << round;
    ASSERT_TRUE(twice_area(result.points, result.triangles) == [&] {
      Wide sum = 0;
      std::uint32_t first = 0;
      std::vector<Points> rings;
      for (const std::uint32_t end : loops.ends) {
        rings.emplace_back(loops.points.begin() + first, loops.points.begin() + end);
        first = end;
      }
      for (const Points& ring : rings) {  // a ring counts by the number of rings around it
        const PlaneSegments own = segments_of(std::vector{static_cast<std::uint32_t>(ring.size())});
        const Wide area = twice_enclosed(ring, own);
        int around = 0;
        for (const Points& other : rings) {
          if (&other == &ring) continue;
          around += is_inside(ring[0], other, segments_of(std::vector{static_cast<std::uint32_t>(other.size())}));
        }
        sum += (area < 0 ? -area : area) * (around % 2 ? -1 : 1);
      }
      return sum;
    }()) << round;
    ++done;
  }
  EXPECT_GT(done, 300);
}

TEST(CutCells, KeepAHundredHolesInACell) {
  Loops loops = even_grid(3, 3, 1e6);
  loops.add_rectangle();
  std::mt19937 random(3);
  for (int k = 0; k < 100; ++k)
    add_star(loops.points, loops.ends, random, {1e6 + 1e5 * (k % 10) + 5e4, 1e6 + 1e5 * (k / 10) + 5e4}, 2e4, 4e4, 11,
             true);
  const Cut result = cut(loops);
  expect_sound(loops, result);
  EXPECT_TRUE(twice_area(result.points, result.triangles) == twice_enclosed(loops.points, segments_of(loops.ends)));
}

// A ring that is one unit wide, along 300 cells.
TEST(CutCells, KeepLoopsAUnitApart) {
  Loops loops = even_grid(100, 100);
  std::mt19937 random(3);
  for (const double radius : {40000.0, 39999.0})
    add_star(loops.points, loops.ends, random, {50000, 50000}, radius, radius, 4);
  const Cut result = cut(loops);
  expect_sound(loops, result);
  EXPECT_EQ(result.triangles.size(), 8u);
}

// A strip that is narrower than a cell, in every direction: no grid vertex lies in it, and its triangles stay small.
TEST(CutCells, OfNarrowStripsStaySmall) {
  for (int turn = 0; turn < 24; ++turn) {
    Loops loops = even_grid(40, 40);
    const double angle = 3.14159265 * turn / 24, c = std::cos(angle), s = std::sin(angle);
    const auto at = [&](double x, double y) {
      return ParameterPoint{std::round(20000 + x * c - y * s), std::round(20000 + x * s + y * c)};
    };
    for (int k = -30; k <= 30; ++k) loops.points.push_back(at(600 * k, -100));
    for (int k = 30; k >= -30; --k) loops.points.push_back(at(600 * k + 250, 150));
    loops.close();
    const Cut result = cut(loops);
    expect_sound(loops, result);
    EXPECT_LT(widest(result, 1000), 2.1) << turn;
  }
}

// A grid of one column, or of one row, whose outer loop runs along sides of cells: lines that begin on such a side
// divide the band as well, so its triangles span about one cell.
TEST(CutCells, OfOneColumnAreDividedAlongItsLines) {
  for (const bool is_row : {false, true}) {
    for (const int count : {1, 2, 3, 7, 40}) {
      const double size = 1000 * count;
      Loops loops = even_grid(1, count);
      loops.u.back() = 20000;
      loops.add_rectangle();
      const double low = std::round(0.31 * size), high = std::round(0.77 * size), step = (high - low) / count;
      for (int k = 0; k <= count; ++k) loops.points.push_back({11000, std::round(high - step * k)});
      for (int k = 0; k <= count; ++k) loops.points.push_back({8000, std::round(low + step * k)});
      loops.close();
      if (is_row) {
        std::swap(loops.u, loops.v);
        for (ParameterPoint& p : loops.points) std::swap(p.u, p.v);
      }
      const Cut result = cut(loops);
      expect_sound(loops, result);
      for (const auto& [a, b, c] : result.band) {
        const auto across = [&](std::uint32_t k) { return is_row ? result.points[k].u : result.points[k].v; };
        const auto [least, most] = std::minmax({across(a), across(b), across(c)});
        EXPECT_LE(most - least, 2000) << count;
      }
    }
  }
}

TEST(CutCells, OfCrossingLoopsAreRefused) {
  Loops loops = even_grid(6, 6);
  for (const ParameterPoint p : {ParameterPoint{700, 700}, {5300, 5300}, {5300, 700}, {700, 5300}})
    loops.points.push_back(p);
  loops.close();
  EXPECT_FALSE(cut(loops).ok);
  EXPECT_TRUE(cut(loops).band.empty());
}

}}  // namespace tessera::test
