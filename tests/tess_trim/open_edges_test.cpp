// The number of open edges that a plan states is that of its mesh.

#include "tess_trim/closed_shape.h"

namespace tessera::test { namespace {

/// Moves the start of a loop's second curve along it, so that a gap lies on a side of the rectangle.
TrimLoop with_gap_on_side(const TrimLoop& loop, double gap) {
  TrimLoop moved = loop;
  const Vec3 start = loop.curves[1].points().front(), end = loop.curves[1].points().back();
  moved.curves[1] = space_line(start + gap / length(end - start) * (end - start), end);
  return moved;
}

TEST(OpenEdges, GapsOnSidesAreNotCountedOnceTheyAreClosed) {
  for (const double gap : {1e-5, 1e-4, 1e-3}) {
    std::vector<ModelSurface> faces = drilled_plate();
    const auto add_gap = [&](std::size_t face) {
      const std::vector<TrimLoop>& loops = *faces[face].trims;
      faces[face].trims = std::vector<TrimLoop>{with_gap_on_side(loops[0], gap), loops[1]};
    };
    add_gap(0);
    add_gap(1);
    for (const double tolerance : {0.1, 1e-3}) {
      const ShapeMesh made = mesh_of(joined(faces, 2 * gap), {.tolerance = tolerance});
      EXPECT_TRUE(made.report.closed()) << gap;
      EXPECT_EQ(made.open_edges, 0u) << gap;
    }
    faces.erase(faces.begin() + 3);
    const ShapeMesh open = mesh_of(joined(faces, 2 * gap), {.tolerance = 1e-3});
    EXPECT_GT(open.open_edges, 0u);
    EXPECT_EQ(open.report.open_edges, open.open_edges) << gap;
  }
}

/// Sides of two faces have the same bits, and loops keep the same part of them.
TEST(OpenEdges, PartsOfSharedSidesAreCounted) {
  const TrimLoop part = space_polygon({{0, 0, 0}, {4, 0, 0}, {4, 2, 0}, {0, 2, 0}});
  for (const double corner : {4.0, -4.0}) {
    const std::vector<ModelSurface> faces{rectangle_face({0, 0, 0}, {4, 0, 0}, {0, 3, 0}, {part}),
                                          rectangle_face({corner, 0, 0}, {4, 0, 0}, {0, 3, 0}, {part})};
    const ShapeMesh made = mesh_of(joined(faces, 1e-6), {.tolerance = 1e-3});
    EXPECT_EQ(made.report.t_junctions, 0u);
    EXPECT_EQ(made.report.open_edges, made.open_edges);
    EXPECT_GE(made.open_edges, 6u);
  }
}

}}  // namespace tessera::test
