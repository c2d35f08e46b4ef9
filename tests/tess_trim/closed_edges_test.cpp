// The vertices that faces share along edges.

#include "tess/closing/closed_edges.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numbers>
#include <random>

#include "base/impl_access.h"
#include "tess_trim/closed_shape.h"

namespace tessera::test { namespace {

TEST(ClosedEdges, AreNotMadeOnceTheCallIsCancelled) {
  const PatchSet set = value_of(make_patch_set(joined(cube(), 1e-6)));
  const PatchSet::Impl& impl = impl_of(set);
  const EdgeRuns runs(impl);
  std::vector<Division> divisions;
  for (std::size_t k = 0; k < set.patch_count(); ++k) {
    const Segments rate(2 + static_cast<int>(k));
    divisions.push_back(Division::of(PatchShape::of(set.patch(k)), {rate, rate}, {rate, rate, rate, rate}));
  }
  const std::vector<std::uint8_t> is_joined(4 * divisions.size(), 0);
  const auto close = [&](const std::atomic<bool>* cancel) {
    const auto chord = [](std::uint32_t) { return ChordBound(); };
    return close_edges({impl, runs, divisions, {}, nullptr, is_joined, chord, 1, false, 1e-9, cancel});
  };
  std::atomic<bool> cancel = false;
  for (const Result<ClosedEdges>& made : {close(nullptr), close(&cancel)}) {
    ASSERT_TRUE(made.ok());
    EXPECT_GT(made->edits.size(), 2u);
    EXPECT_LT(made->gap, 1e-15);
  }
  cancel = true;
  EXPECT_EQ(close(&cancel).status().code(), StatusCode::cancelled);
}

/// A curve that starts far from its edge's vertex leaves the other faces there as they are.
TEST(ClosedEdges, VerticesStandWhereTheShapeStatesThem) {
  for (const double gap : {1e-3, 0.1, 1.0}) {
    Shape shape = joined(drilled_plate(), 1e-6);
    std::vector<TrimLoop> loops = *shape.faces[0].trims;
    const Vec3 start = loops[0].curves[1].points().front(), end = loops[0].curves[1].points().back();
    loops[0].curves[1] = space_line(start + gap / length(end - start) * (end - start), end);
    shape.faces[0].trims = std::move(loops);
    const ShapeMesh made = mesh_of(shape, {.tolerance = 1e-3});
    EXPECT_TRUE(made.report.closed()) << gap;
    EXPECT_EQ(made.open_edges, 0u) << gap;
    EXPECT_NEAR(made.gap, gap, 1e-6);
    const auto [volume, area] = volume_and_area(made.mesh);
    EXPECT_NEAR(volume, drilled_volume(), area * (made.bound + 1e-6)) << gap;
  }
}

/// The triangle a, b, c as a face with a pole at c, on side 0 .. 3 of its domain. Its patches meet at `lines`, shares
/// of the way to c.
ModelSurface triangle_face(const Vec3& a, const Vec3& b, const Vec3& c, unsigned side, std::vector<double> lines) {
  const bool is_last = side % 2 == 0, along_u = side < 2;
  lines.insert(lines.begin(), 0), lines.push_back(1);
  std::vector<Vec3> points;
  const std::size_t rows = lines.size();
  for (std::size_t k = 0; k < 2 * rows; ++k) {
    const std::size_t row = along_u ? k / 2 : k % rows;
    const double share = is_last ? lines[row] : lines[rows - 1 - row];
    points.push_back((1 - share) * ((along_u ? k % 2 : k / rows) ? b : a) + share * c);
  }
  if (!is_last) {
    std::ranges::reverse(lines);
    for (double& line : lines) line = 1 - line;
  }
  lines.insert(lines.begin(), 0), lines.push_back(1);
  const std::vector<double> across{0, 0, 1, 1};
  return {.name = std::string("triangle"),
          .surface =
              value_of(BSplineSurface::polynomial(1, along_u ? lines : across, 1, along_u ? across : lines, points))};
}

/// Pyramids whose faces have poles at the top, and vertices where others have none along their common edges.
TEST(ClosedEdges, TrianglesAtPolesTakeTheVerticesOfTheirNeighbours) {
  std::mt19937_64 random(5);
  const auto number = [&](double to) { return std::uniform_real_distribution<double>(0, to)(random); };
  for (int round = 0; round < 60; ++round) {
    const std::size_t count = 3 + random() % 4;
    std::vector<Vec3> corners;
    for (std::size_t k = 0; k < count; ++k) {
      const double angle = 2 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(count);
      corners.push_back({2 * std::cos(angle), 2 * std::sin(angle), 0});
    }
    std::vector<Vec3> base;
    for (const Vec3& p : corners) base.push_back(p + Vec3{2, 2, 0});
    std::vector<ModelSurface> faces{rectangle_face({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}, {space_polygon(base)})};
    for (std::size_t k = 0; k < count; ++k) {
      std::vector<double> lines;
      for (double at = 0.1 + number(0.4); lines.size() < random() % 4 && at < 0.95; at += 0.1 + number(0.4))
        lines.push_back(at);
      faces.push_back(triangle_face(corners[k], corners[(k + 1) % count], {0, 0, 3}, random() % 4, lines));
    }
    const ShapeMesh made = mesh_of(joined(faces, 1e-6), {.tolerance = 1e-3});
    EXPECT_TRUE(made.report.closed()) << round << ": " << made.report.open_edges << " open edges";
    EXPECT_EQ(made.open_edges, 0u) << round;
    const double sector = std::sin(2 * std::numbers::pi / static_cast<double>(count)),
                 radius = 2 * std::cos(std::numbers::pi / static_cast<double>(count));
    const double side = 2 * std::sin(std::numbers::pi / static_cast<double>(count)) * std::hypot(3, radius);
    EXPECT_NEAR(volume_and_area(made.mesh)[1], static_cast<double>(count) * (2 * sector + side), 1e-4) << round;
  }
}

}}  // namespace tessera::test
