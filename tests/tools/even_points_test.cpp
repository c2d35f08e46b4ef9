// Points spread over triangles by area.

#include "compare/even_points.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace tessera::cli { namespace {

/// A unit square of two triangles, and a triangle as large as `share` of it.
Mesh square_and_triangle(float share) {
  Mesh mesh;
  mesh.positions = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 5, 0, 0, 5 + 2 * share, 0, 0, 5, 1, 0};
  mesh.indices = {0, 1, 2, 0, 2, 3, 4, 5, 6};
  return mesh;
}

TEST(EvenPoints, EqualAreasGetEquallyMany) {
  const Mesh mesh = square_and_triangle(0.25);
  const Result<EvenPoints> even = EvenPoints::make(mesh);
  ASSERT_TRUE(even.ok());
  EXPECT_DOUBLE_EQ(even->area(), 1.25);
  constexpr std::size_t count = 1000;
  std::vector<std::size_t> found(3);
  for (std::size_t k = 0; k < count; ++k) ++found[even->point(k, count).triangle];
  EXPECT_EQ(found, (std::vector<std::size_t>{400, 400, 200}));
}

/// A square of 32 x 32 cells gets four points a cell: none is empty, while random points leave 19 of them empty.
TEST(EvenPoints, FillTheirTriangles) {
  const Mesh mesh = square_and_triangle(0);
  const Result<EvenPoints> even = EvenPoints::make(mesh);
  ASSERT_TRUE(even.ok());
  constexpr std::size_t side = 32, count = 4 * side * side;
  std::vector<int> cells(side * side);
  Vec3 sum;
  for (std::size_t k = 0; k < count; ++k) {
    const TrianglePoint point = even->point(k, count);
    EXPECT_GE(point.b, 0);
    EXPECT_GE(point.c, 0);
    EXPECT_LE(point.b + point.c, 1);
    const Vec3 place = place_of(mesh, point);
    sum += place;
    const auto cell = [](double x) { return std::min(static_cast<std::size_t>(x * side), side - 1); };
    ++cells[cell(place.x) * side + cell(place.y)];
  }
  EXPECT_LE(std::ranges::count(cells, 0), 2);
  EXPECT_NEAR(sum.x / count, 0.5, 1e-3);
  EXPECT_NEAR(sum.y / count, 0.5, 1e-3);
}

TEST(EvenPoints, TrianglesWithoutAnAreaGetNone) {
  Mesh mesh = square_and_triangle(0);  // the last triangle is a line
  const Result<EvenPoints> even = EvenPoints::make(mesh);
  ASSERT_TRUE(even.ok());
  for (std::size_t k = 0; k < 100; ++k) EXPECT_LT(even->point(k, 100).triangle, 2u);
  EXPECT_LT(even->point(0, 1).triangle, 2u);
  mesh.indices = {4, 5, 6};
  EXPECT_EQ(EvenPoints::make(mesh).status().code(), StatusCode::invalid_argument);
}

TEST(EvenPoints, AreasThatOverflowAreAnError) {
  Mesh mesh = square_and_triangle(1);
  for (const float p : mesh.positions) mesh.model_positions.push_back(1e200 * double{p});
  EXPECT_EQ(EvenPoints::make(mesh).status().message(), "the areas of the mesh's triangles overflow");
}

}}  // namespace tessera::cli
