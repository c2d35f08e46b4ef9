// Triangulation allocates nothing on repetition.

#include "plane/cut_cells.h"
#include "plane/plane_reference.h"
#include "support/allocations.h"

namespace tessera::test { namespace {

TEST(TrimmedAllocation, NoneOnRepetition) {
  std::vector<double> lines;
  for (int k = 0; k <= 20; ++k) lines.push_back(1000 * k);
  Points points;
  std::vector<std::uint32_t> ends;
  std::mt19937 random(1);
  for (int k = 0; k < 16; ++k)
    add_star(points, ends, random, {2500.0 + 5000 * (k % 4), 2500.0 + 5000 * (k / 4)}, 1500, 2400, 50);
  const PlaneSegments chords = segments_of(ends);
  PolygonTriangles polygons;
  CutCells cells;
  ASSERT_TRUE(polygons.run_rings(points, ends));
  ASSERT_TRUE(cells.run({lines, lines}, points, chords));
  const std::size_t before = allocation_count();
  EXPECT_GT(before, 0u);  // the count works
  for (int repeat = 0; repeat < 5; ++repeat) {
    ASSERT_TRUE(polygons.run_rings(points, ends));
    ASSERT_TRUE(cells.run({lines, lines}, points, chords));
  }
  EXPECT_EQ(allocation_count(), before);
}

}}  // namespace tessera::test
