// Quadrics as faces of closed shapes.

#include "support/quadrics.h"
#include "tess_trim/closed_shape.h"

namespace tessera::test { namespace {

constexpr double pi = std::numbers::pi;

ModelSurface quadric_face(const QuadricPiece& part) { return {.name = std::string("quadric"), .surface = part}; }

/// A disc across the z axis, its normal along it or against it; its loop starts at an angle of `turn`.
ModelSurface disc(double z, double radius, bool up, double turn) {
  const double a = 1.2 * radius;
  const Vec3 along{2 * a, 0, 0}, across{0, 2 * a, 0};
  return rectangle_face({-a, -a, z}, up ? along : across, up ? across : along,
                        {circle_loop(a, a, radius, false, turn)});
}

/// Faces of quadrics that meet exactly have no gaps along their edges but for the errors of the maps of their
/// parameters: 1e-8 of the edge's extent in joined_shape(), 1e-9 of the ranges in grid_trims().
TEST(ClosedQuadrics, MeetOthersWithoutGaps) {
  const ModelSurface pipe = quadric_face(piece(quadric({.a = 1, .b = 1, .k = -1}), {0, 2 * pi, 0, 1})),
                     cone = quadric_face(piece(quadric({.a = 1, .b = 1, .c = -1}), {0, 2 * pi, 1, 2})),
                     dome = quadric_face(piece(quadric({.a = 1, .b = 1, .c = 1, .k = -1}), {0, 2 * pi, 0, pi / 2}));
  struct Solid {
    std::vector<ModelSurface> faces;
    double volume;
  };
  for (const double turn : {0.0, 0.3, 2.0}) {
    const Solid solids[] = {{{pipe, disc(0, 1, false, turn), disc(1, 1, true, turn)}, pi},
                            {{cone, disc(1, 1, false, turn), disc(2, 2, true, turn)}, 7 * pi / 3},
                            {{dome, disc(0, 1, false, turn)}, 2 * pi / 3}};
    for (const Solid& solid : solids)
      for (const double tolerance : {0.1, 1e-3, 1e-5}) {
        const ShapeMesh made = mesh_of(joined(solid.faces, 1e-6), {.tolerance = tolerance});
        EXPECT_TRUE(made.report.closed()) << turn;
        EXPECT_EQ(made.open_edges, 0u);
        EXPECT_LE(made.gap, 1e-8 * 4 + 1e-9 * 4 * pi);
        const auto [volume, area] = volume_and_area(made.mesh);
        EXPECT_NEAR(std::abs(volume), solid.volume, area * (made.bound + made.gap));
      }
  }
}

}}  // namespace tessera::test
