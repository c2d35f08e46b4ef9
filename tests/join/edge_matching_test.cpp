// Edges of faces that share none: which become one, where they are divided, and how they are paired.

#include "tessera/edge_matching.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "join/unjoined_faces.h"
#include "tessera/coons_patch.h"
#include "tessera/nurbs_surface.h"
#include "tessera/quadric.h"

namespace tessera::test { namespace {

TEST(EdgeMatching, SidesOfACubeBecomeTwelveEdges) {
  const Shape shape = joined(cube(), 1e-3);
  EXPECT_EQ(counts_of(shape), (Counts{{2, 12}}));
  EXPECT_EQ(shape.vertices.size(), 8u);
  EXPECT_EQ(closed_count(shape), 1u);
  EXPECT_EQ(shape.solid_count, 1u);
  EXPECT_EQ(largest_gap(shape), 0);
  std::vector<ModelSurface> two = cube();
  for (const ModelSurface& face : cube(2, {5, 0, 0})) two.push_back(face);
  EXPECT_EQ(joined(two, 1e-3).solid_count, 2u);
  two.erase(two.begin());
  const Shape open = joined(two, 1e-3);
  EXPECT_EQ(counts_of(open), (Counts{{1, 4}, {2, 20}}));
  EXPECT_EQ(open.shells.size(), 2u);
  EXPECT_EQ(open.solid_count, 1u);
}

TEST(EdgeMatching, ASideIsDividedWhereThreeMeetIt) {
  const Shape shape = joined(one_against_three(0.3, 0.7), 1e-3);
  EXPECT_EQ(counts_of(shape), (Counts{{1, 8}, {2, 5}}));
  EXPECT_EQ(edge_loops(shape.faces[0])[0].curves.size(), 6u);
  EXPECT_LT(largest_gap(shape), 1e-15);
  // Each curve begins where the one before it ends.
  for (const ShapeFace& face : shape.faces) {
    const std::vector<Curve>& curves = edge_loops(face)[0].curves;
    for (std::size_t k = 0; k < curves.size(); ++k) {
      const Curve &before = curves[k], &after = curves[(k + 1) % curves.size()];
      EXPECT_LT(length(position(before, before.domain().to) - position(after, after.domain().from)), 1e-15);
    }
  }
}

TEST(EdgeMatching, PartsOfASideOverlap) {
  // Both sides reach beyond the other's.
  const std::vector<ModelSurface> faces{quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}),
                                        quad({1, 0.25, 0}, {2, 0.25, 0}, {2, 1.5, 0}, {1, 1.5, 0})};
  const Shape shape = joined(faces, 1e-3);
  EXPECT_EQ(counts_of(shape), (Counts{{1, 8}, {2, 1}}));
  EXPECT_EQ(shape.vertices.size(), 8u);
}

TEST(EdgeMatching, ATouchingCornerDividesNothing) {
  const std::vector<ModelSurface> faces{quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}),
                                        quad({1, 0.5, 0}, {2, 0, 0}, {3, 0.5, 0}, {2, 1, 0})};
  EXPECT_EQ(counts_of(joined(faces, 1e-3)), (Counts{{1, 8}}));
}

TEST(EdgeMatching, DistanceDecides) {
  for (const double distance : {1e-6, 1e-3, 0.1}) {
    const auto moved = [&](double gap) { return joined(one_against_three(0.3, 0.7, gap * distance), distance); };
    EXPECT_EQ(counts_of(moved(0.99)), (Counts{{1, 8}, {2, 5}})) << distance;
    EXPECT_NEAR(largest_gap(moved(0.99)), 0.99 * distance, 0.02 * distance);
    EXPECT_EQ(counts_of(moved(1.01)), (Counts{{1, 12}, {2, 2}})) << distance;
  }
}

/// The second face's side runs along the first one's, by another curve.
Shape beside(const Curve& first, const Curve& second, double distance) {
  const auto face = [](const Curve& side, double height) {
    std::vector<Vec3> points(side.points().begin(), side.points().end());
    for (Vec3& p : points) p = p + Vec3{0, 0, height};
    const std::vector<double> weights(side.weights().begin(), side.weights().end());
    const Curve other = value_of(Curve::bezier(points, weights, side.domain()));
    return ModelSurface{"wall", value_of(RuledSurface::make(side, other))};
  };
  return joined({face(first, 1), face(second, -1)}, distance);
}

TEST(EdgeMatching, PacesOfCurvesArePaired) {
  const double c = std::sqrt(0.5);
  const std::vector<Vec3> arc{{1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, back{{0, 1, 0}, {1, 1, 0}, {1, 0, 0}};
  const auto rational = [](const std::vector<Vec3>& points, double a, double b, double w, const Interval& range) {
    return value_of(Curve::bezier(points, std::vector<double>{a, w, b}, range));
  };
  const Curve first = rational(arc, 1, 1, c, {0, 1});
  // Moebius changes of the parameter: the weights 1, k c, k^2 are those of the same arc.
  for (const double k : {0.25, 1.0, 3.0})
    for (const auto& points : {arc, back}) {
      const Shape shape = beside(first, rational(points, 1, k * k, k * c, {-3, 5}), 1e-3);
      EXPECT_EQ(counts_of(shape), (Counts{{1, 6}, {2, 1}})) << k;
      EXPECT_LT(largest_gap(shape), 1e-14) << k;
    }
  // A polynomial change has no fraction that equals it.
  const Curve even = space_line({0, 0, 0}, {1, 0, 0});
  const Curve slow = value_of(Curve::bezier(std::vector<Vec3>{{1, 0, 0}, {0.7, 0, 0}, {0, 0, 0}}, {}, {2, 3}));
  const Shape shape = beside(even, slow, 1e-3);
  EXPECT_EQ(counts_of(shape), (Counts{{1, 6}, {2, 1}}));
  EXPECT_LT(largest_gap(shape), 1.5e-8);
  EXPECT_LT(largest_gap(value_of(joined_edges(shape, 1e-3))), 1.5e-8);
}

TEST(EdgeMatching, ParametersOfThePairAreWithinTheGap) {
  // A cubic wave against the same, moved by 1e-4 across, at another pace.
  const std::vector<Vec3> wave{{0, 0, 0}, {1, 1, 0}, {2, -1, 0}, {3, 0, 0}};
  const Curve first = value_of(Curve::bezier(wave));
  const Curve quick =
      value_of(Curve::bezier(std::vector<Vec3>{{0, 1e-4, 0}, {1, 1 + 1e-4, 0}, {2, -1 + 1e-4, 0}, {3, 1e-4, 0}},
                             std::vector<double>{1, 1.7, 1.7 * 1.7, 1.7 * 1.7 * 1.7}));
  const Shape shape = beside(first, quick, 1e-3);
  EXPECT_EQ(counts_of(shape), (Counts{{1, 6}, {2, 1}}));
  EXPECT_LT(largest_gap(shape), 1.3e-4);
}

TEST(EdgeMatching, CirclesWithDifferentStartsMeet) {
  const Axis axis;
  const BSplineSurface wall = value_of(make_nurbs_cylinder(axis, 1, 1));
  std::vector<ModelSurface> faces{{"wall", wall}};
  for (const double angle : {0.0, 1.0, 3.2}) {
    faces.erase(faces.begin() + 1, faces.end());
    for (const double z : {0.0, 1.0}) {
      Axis centre;
      centre.origin = {0.5, 0.5, 0};
      const Curve circle = value_of(make_nurbs_circle(centre, 0.25));
      std::vector<Vec3> points(circle.points().begin(), circle.points().end());
      const Affine turn = Affine::rotated({0, 0, 1}, z == 0 ? angle : -angle);
      for (Vec3& p : points) p = turn.point(p - centre.origin) + centre.origin;
      const TrimLoop loop{{value_of(Curve::nurbs(2, points, circle.weights(), circle.knots()))}, false, {}};
      ModelSurface disc = quad({-2, -2, z}, {2, -2, z}, {2, 2, z}, {-2, 2, z});
      disc.trims = std::vector<TrimLoop>{loop};
      faces.push_back(disc);
    }
    const Shape shape = joined(faces, 1e-4);
    EXPECT_EQ(counts_of(shape), angle == 0 ? (Counts{{2, 3}}) : (Counts{{2, 5}})) << angle;
    EXPECT_EQ(shape.solid_count, 1u);
    EXPECT_LT(largest_gap(shape), 3e-8) << angle;
  }
}

TEST(EdgeMatching, SeamsAndPolesOfClosedSurfaces) {
  const Shape ball = joined({{"ball", value_of(make_nurbs_sphere({}, 2))}}, 1e-3);
  EXPECT_EQ(counts_of(ball), (Counts{{0, 2}, {2, 1}}));
  EXPECT_EQ(ball.vertices.size(), 2u);
  EXPECT_EQ(ball.solid_count, 1u);
  const Shape ring = joined({{"ring", value_of(make_nurbs_torus({}, 3, 1))}}, 1e-3);
  EXPECT_EQ(counts_of(ring), (Counts{{2, 2}}));
  EXPECT_EQ(ring.vertices.size(), 1u);
  EXPECT_EQ(ring.solid_count, 1u);
  EXPECT_LT(largest_gap(ring), 1e-12);
  // A quadric's loops are in its own parameters.
  const Quadric sphere = value_of(Quadric::make({.a = 1, .b = 1, .c = 1, .k = -4}));
  const double turn = std::numbers::pi;
  std::vector<ModelSurface> halves;
  for (const auto& [from, to] : {std::pair(-turn / 2, 0.3), std::pair(0.3, turn / 2)})
    halves.push_back({"half", value_of(QuadricPiece::make(sphere, {0, 2 * turn, from, to}))});
  const Shape quadrics = joined(halves, 1e-3);
  EXPECT_EQ(counts_of(quadrics), (Counts{{0, 2}, {2, 3}}));
  EXPECT_EQ(quadrics.solid_count, 1u);
  EXPECT_LT(largest_gap(quadrics), 1e-12);
}

TEST(EdgeMatching, NarrowSlitsAreClosed) {
  ModelSurface face = quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
  const auto with_slit = [&](double width) {
    face.trims = std::vector<TrimLoop>{
        space_polygon({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}),
        space_polygon({{0.2, 0.5, 0}, {0.8, 0.5, 0}, {0.8, 0.5 + width, 0}, {0.2, 0.5 + width, 0}}, true)};
    return joined({face}, 1e-3);
  };
  EXPECT_EQ(counts_of(with_slit(1e-2)), (Counts{{1, 8}}));
  EXPECT_EQ(counts_of(with_slit(0.9e-3)), (Counts{{0, 2}, {1, 4}, {2, 1}}));
  EXPECT_EQ(counts_of(with_slit(1e-9)), (Counts{{0, 2}, {1, 4}, {2, 1}}));
}

/// A face narrower than the distance, alone or between two wide ones, keeps its area: its sides stay two edges.
TEST(EdgeMatching, NarrowFacesAreNoSlits) {
  constexpr double distance = 1e-3;
  for (const double width : {0.07, 0.1, 0.3, 0.9}) {
    const double w = width * distance;
    const ModelSurface strip = quad({0, 0, 0}, {1, 0, 0}, {1, w, 0}, {0, w, 0});
    const ModelSurface below = quad({0, -1, 0}, {1, -1, 0}, {1, 0, 0}, {0, 0, 0}),
                       above = quad({0, w, 0}, {1, w, 0}, {1, 1, 0}, {0, 1, 0});
    EXPECT_EQ(counts_of(joined({strip}, distance)), (Counts{{1, 4}})) << width;
    EXPECT_EQ(counts_of(joined({below, strip, above}, distance)), (Counts{{1, 8}, {2, 2}})) << width;
    ModelSurface trimmed = quad({-1, -1, 0}, {2, -1, 0}, {2, 1, 0}, {-1, 1, 0});  // parameters from 0 to 1
    trimmed.trims = std::vector<TrimLoop>{
        space_polygon({{0.2, 0.5, 0}, {0.6, 0.5, 0}, {0.6, 0.5 + w / 2, 0}, {0.2, 0.5 + w / 2, 0}})};
    EXPECT_EQ(counts_of(joined({trimmed}, distance)), (Counts{{1, 4}})) << width;
  }
}

TEST(EdgeMatching, ThreeFacesMeetInOneEdge) {
  const auto fan = [](double gap) {
    return joined({quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}), quad({1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}),
                   quad({1, 0, gap}, {1, 0, 1}, {1, 1, 1}, {1, 1, gap})},
                  1e-3);
  };
  EXPECT_EQ(counts_of(fan(0)), (Counts{{1, 9}, {3, 1}}));
  EXPECT_EQ(counts_of(fan(1e-4)), (Counts{{1, 9}, {3, 1}}));
  EXPECT_EQ(counts_of(fan(0.5e-3)), (Counts{{1, 10}, {2, 1}}));  // the two that meet better
}

TEST(EdgeMatching, EdgesShorterThanTheDistance) {
  // The square in the middle of three is narrower than the distance: it becomes a line.
  const Shape shape = joined(one_against_three(0.5, 0.5003), 1e-3);
  EXPECT_EQ(counts_of(shape), (Counts{{0, 1}, {1, 8}, {2, 4}}));
  // Short edges that faces share stay edges.
  EXPECT_EQ(counts_of(joined(cube(1e-4), 1e-3)), (Counts{{2, 12}}));
  EXPECT_EQ(counts_of(joined(cube(1e-6), 1e-3)), (Counts{{0, 24}}));
}

/// Two strips narrower than the distance, in line, apart by more than their width. Their long sides meet the faces
/// above and below, so the short sides between them have the same vertices.
TEST(EdgeMatching, ShortEdgesBetweenTheSameVerticesAreOne) {
  constexpr double distance = 1e-3, width = 0.3 * distance, gap = 0.9 * distance, next = 1 + gap;
  std::vector<ModelSurface> faces{quad({0, width, 0}, {2, width, 0}, {2, 1, 0}, {0, 1, 0}),
                                  quad({0, -1, 0}, {2, -1, 0}, {2, 0, 0}, {0, 0, 0}),
                                  quad({0, 0, 0}, {1, 0, 0}, {1, width, 0}, {0, width, 0})};
  for (const ModelSurface& strip : {quad({next, 0, 0}, {2, 0, 0}, {2, width, 0}, {next, width, 0}),
                                    quad({next, 0, 0}, {next, width, 0}, {2, width, 0}, {2, 0, 0})}) {
    faces.push_back(strip);
    const Shape shape = joined(faces, distance);
    EXPECT_EQ(counts_of(shape), (Counts{{1, 8}, {2, 5}}));
    EXPECT_NEAR(largest_gap(shape), gap, 1e-3 * gap);  // 1.05 gap if one ran the other way
    faces.pop_back();
  }
}

/// Four sides in parallel, each within the distance of the next alone. The end of the first divides the second, this
/// place divides the third, and the third's the fourth.
TEST(EdgeMatching, PlacesThatDivideACurveDivideItsNeighbours) {
  constexpr double distance = 1e-3;
  const auto wall = [](double x, double length, const Vec3& to) {
    return quad({x, 0, 0}, {x, length, 0}, Vec3{x, length, 0} + to, Vec3{x, 0, 0} + to);
  };
  const ModelSurface first = wall(0, 1, {-1, 0, 0}), second = wall(0.5 * distance, 2, {0, 0, -1}),
                     third = wall(1.2 * distance, 2, {0, 0, 1}), fourth = wall(2 * distance, 2, {1, 0, 0});
  EXPECT_EQ(counts_of(joined({first, second}, distance)), (Counts{{1, 7}, {2, 1}}));
  EXPECT_EQ(counts_of(joined({first, second, third}, distance)), (Counts{{1, 10}, {2, 2}}));
  EXPECT_EQ(counts_of(joined({first, second, third, fourth}, distance)), (Counts{{1, 13}, {2, 3}}));
}

}}  // namespace tessera::test
