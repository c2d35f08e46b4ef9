// Bodies bounded by planes, cylinders, cones, spheres and tori: their areas and volumes, however faces are bounded.

#include <gtest/gtest.h>

#include "io_step/step_builder.h"

namespace tessera::test { namespace {

using std::numbers::pi;

/// Circles at two heights of a cylinder about z, and its ends.
struct Tube {
  explicit Tube(double radius = 2, double height = 3) : r(radius), h(height) {
    low = b.edge({r, 0, 0}, {r, 0, 0}, b.placed("CIRCLE", b.axes({0, 0, 0}), {r}));
    high = b.edge({r, 0, h}, {r, 0, h}, b.placed("CIRCLE", b.axes({0, 0, h}), {r}));
    side = b.placed("CYLINDRICAL_SURFACE", b.axes({0, 0, 0}), {r});
    bottom = b.flat({0, 0, 0}, {0, 0, -1}, {1, 0, 0}, {b.loop({-low})});
    top = b.flat({0, 0, h}, {0, 0, 1}, {1, 0, 0}, {b.loop({high})});
  }
  void expect(int face) {
    const Model model = expect_solid(b.file({b.solid({bottom, top, face})}), 2 * pi * r * (r + h), pi * r * r * h);
    expect_outward(model, {0, 0, h / 2});
  }
  StepBuilder b;
  double r, h;
  int low, high, side, bottom, top;
};

TEST(StepSolids, CylindersHaveASeamOrTwoLoops) {
  Tube seamed;
  const int seam = seamed.b.straight({2, 0, 0}, {2, 0, 3});
  seamed.expect(seamed.b.face(seamed.side, {seamed.b.loop({seamed.low, seam, -seamed.high, -seam})}));
  Tube bare;
  bare.expect(bare.b.face(bare.side, {bare.b.loop({bare.low}), bare.b.loop({-bare.high})}));
  Tube exchanged;  // the upper loop first
  exchanged.expect(
      exchanged.b.face(exchanged.side, {exchanged.b.loop({-exchanged.high}), exchanged.b.loop({exchanged.low})}));
}

TEST(StepSolids, SensesOfFacesAndBoundsAreKept) {
  // A surface that looks inwards: the face disagrees, loops run about the face's normal.
  Tube plane;
  StepBuilder& b = plane.b;
  plane.top = b.face(b.placed("PLANE", b.axes({0, 0, 3}, {0, 0, -1})), {b.loop({plane.high})}, false);
  plane.expect(b.face(plane.side, {b.loop({plane.low}), b.loop({-plane.high})}));
  Tube bound;
  StepBuilder& c = bound.b;
  bound.top = c.face_of(c.placed("PLANE", c.axes({0, 0, 3})), {c.bound(c.loop({-bound.high}), false)});
  bound.expect(c.face_of(bound.side, {c.bound(c.loop({-bound.low}), false), c.bound(c.loop({bound.high}), false)}));
}

/// A tube without its wall's outside: the side face of the hole of a square plate, which disagrees with its cylinder.
TEST(StepSolids, HolesAreCutThroughPlates) {
  Tube t;
  StepBuilder& b = t.b;
  StepBuilder::Numbers faces = b.box_faces({-5, -4, 0}, {6, 4, 3});
  const auto side = [&](double z, bool is_top) {
    std::vector<Vec3> corners{{-5, -4, z}, {6, -4, z}, {6, 4, z}, {-5, 4, z}};
    if (!is_top) std::reverse(corners.begin(), corners.end());
    const int outer = b.bound(b.polygon_loop(corners), true, "FACE_OUTER_BOUND");
    const int hole = b.bound(b.loop({is_top ? -t.high : t.low}));
    return b.face_of(b.placed("PLANE", b.axes({0, 0, z}, {0, 0, is_top ? 1.0 : -1.0})), {hole, outer});
  };
  faces[0] = side(0, false), faces[1] = side(3, true);
  faces.push_back(b.face(t.side, {b.loop({-t.low}), b.loop({t.high})}, false));
  expect_solid(b.file({b.solid(faces)}), 2 * (88 - 4 * pi) + 3 * 38 + 12 * pi, 3 * (88 - 4 * pi));
}

TEST(StepSolids, WholeSpheresHaveAVertexLoop) {
  for (const Vec3& place : {Vec3{1, 2, 5}, Vec3{3, 2, 3}, Vec3{1, 2, 1}}) {
    StepBuilder b;
    const int ball = b.placed("SPHERICAL_SURFACE", b.axes({1, 2, 3}), {2});
    const Model model = expect_solid(b.file({b.solid({b.face(ball, {b.vertex_loop(place)})})}), 16 * pi, 32 * pi / 3);
    expect_outward(model, {1, 2, 3});
  }
}

TEST(StepSolids, HalfBallsAreCutThroughBothPoles) {
  StepBuilder b;
  const int ball = b.placed("SPHERICAL_SURFACE", b.axes({0, 0, 0}), {2});
  const int circle = b.placed("CIRCLE", b.axes({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), {2});
  // Edges from one side of the equator to the other, across the poles; and from pole to pole.
  for (const Vec3& end : {Vec3{0, 2, 0}, Vec3{0, 0, 2}, Vec3{0, std::sqrt(2.0), std::sqrt(2.0)}}) {
    StepBuilder::Numbers edges{b.edge(end, -end, circle), b.edge(-end, end, circle)};
    const int round = b.face(ball, {b.loop(edges)});
    const int disc = b.flat({0, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {b.loop({-edges[1], -edges[0]})});
    StepBuilder part = b;
    const Model model = expect_solid(part.file({part.solid({round, disc})}), 12 * pi, 16 * pi / 3);
    expect_outward(model, {0.5, 0, 0});
  }
}

TEST(StepSolids, CapsAndTheRestsOfBallsHaveOneCircle) {
  // A ball about the origin, cut at distance 1 along an axis: the cap beyond, and the rest.
  for (const Vec3& axis : {Vec3{0, 0, 1}, Vec3{0, 0, -1}, Vec3{1, 0, 0}, Vec3{-1, 0, 0}, Vec3{0, 0.6, 0.8}})
    for (const bool is_cap : {true, false}) {
      StepBuilder b;
      const Vec3 across = normalized(cross(axis, Vec3{0.3, 1, 0.2}));
      const double r = 2, radius = std::sqrt(3.0);
      const int ball = b.placed("SPHERICAL_SURFACE", b.axes({0, 0, 0}), {r});
      const Vec3 start = axis + radius * across;
      const int circle = b.edge(start, start, b.placed("CIRCLE", b.axes(axis, axis, across), {radius}));
      const int round = b.face(ball, {b.loop({is_cap ? circle : -circle})});
      const int disc = b.flat(axis, is_cap ? -axis : axis, across, {b.loop({is_cap ? -circle : circle})});
      const double cap = 2 * pi * r * (r - 1), volume = pi * (r - 1) * (r - 1) * (2 * r + 1) / 3;
      const double area = (is_cap ? cap : 16 * pi - cap) + 3 * pi;
      const Model model = expect_solid(b.file({b.solid({round, disc})}), area, is_cap ? volume : 32 * pi / 3 - volume);
      expect_outward(model, is_cap ? 1.2 * axis : Vec3{});
    }
}

TEST(StepSolids, ConesReachTheirApex) {
  // Radius 3 at z = 0, half angle 45 degrees, apex at z = 3 (the axis points down, so that radii grow along it).
  const double slope = std::sqrt(2.0);
  for (const int how : {0, 1, 2}) {
    StepBuilder b;
    const Vec3 rim{3, 0, 0}, apex{0, 0, 3};
    const int cone = b.placed("CONICAL_SURFACE", b.axes({0, 0, 0}, {0, 0, -1}), {3, pi / 4});
    const int circle = b.edge(rim, rim, b.placed("CIRCLE", b.axes({0, 0, 0}), {3}));
    const int seam = how == 0 ? b.straight(rim, apex) : 0;
    StepBuilder::Numbers loops{how == 0 ? b.loop({circle, seam, -seam}) : b.loop({circle})};
    if (how == 1) loops.push_back(b.vertex_loop(apex));
    const int disc = b.flat({0, 0, 0}, {0, 0, -1}, {1, 0, 0}, {b.loop({-circle})});
    const Model model = expect_solid(b.file({b.solid({b.face(cone, loops), disc})}), 9 * pi * (1 + slope), 9 * pi);
    expect_outward(model, {0, 0, 1});
  }
}

/// Circles of a torus about z: along it at the angle v of its tube, and around the tube at the angle u.
struct Ring {
  Ring() { surface = b.placed("TOROIDAL_SURFACE", b.axes({0, 0, 0}), {major, minor}); }
  Vec3 at(double u, double v) const {
    const double ring = major + minor * std::cos(v);
    return {ring * std::cos(u), ring * std::sin(u), minor * std::sin(v)};
  }
  int along(double v, double from, double to) {
    const double z = minor * std::sin(v);
    return b.edge(at(from, v), at(to, v), b.placed("CIRCLE", b.axes({0, 0, z}), {major + minor * std::cos(v)}));
  }
  int around(double u, double from, double to) {
    const Vec3 out{std::cos(u), std::sin(u), 0};
    return b.edge(at(u, from), at(u, to), b.placed("CIRCLE", b.axes(major * out, cross(out, {0, 0, 1}), out), {minor}));
  }
  StepBuilder b;
  double major = 5, minor = 2;
  int surface;
};

TEST(StepSolids, ToriAreWholeOrSectors) {
  Ring ring;
  const int long_seam = ring.along(0, 0, 0), short_seam = ring.around(0, 0, 0);
  const int loop = ring.b.loop({long_seam, short_seam, -long_seam, -short_seam});
  const double area = 4 * pi * pi * 10, volume = 2 * pi * pi * 20;
  expect_solid(ring.b.file({ring.b.solid({ring.b.face(ring.surface, {loop})})}), area, volume);
  Ring bare;
  const int point_loop = bare.b.vertex_loop(bare.at(0, 0));
  expect_solid(bare.b.file({bare.b.solid({bare.b.face(bare.surface, {point_loop})})}), area, volume);
  // A third of a turn, with discs at its ends, with a seam and without.
  for (const bool has_seam : {true, false}) {
    Ring part;
    StepBuilder& b = part.b;
    const double u = 2 * pi / 3;
    const int first = part.around(0, 0, 0), last = part.around(u, 0, 0);
    const int seam = has_seam ? part.along(0, 0, u) : 0;
    const StepBuilder::Numbers loops = has_seam ? StepBuilder::Numbers{b.loop({seam, last, -seam, -first})}
                                                : StepBuilder::Numbers{b.loop({-first}), b.loop({last})};
    const Vec3 end{std::cos(u), std::sin(u), 0};
    const int disc = b.flat({5, 0, 0}, {0, -1, 0}, {1, 0, 0}, {b.loop({first})});
    const int other = b.flat(5 * end, cross({0, 0, 1}, end), end, {b.loop({-last})});
    expect_solid(b.file({b.solid({b.face(part.surface, loops), disc, other})}), area / 3 + 8 * pi, volume / 3);
  }
}

TEST(StepSolids, TorusBandsLieBetweenTwoCircles) {
  // The upper half, from the outer circle to the inner one across the top, and the lower half.
  for (const bool is_upper : {true, false}) {
    Ring ring;
    StepBuilder& b = ring.b;
    const int outer = ring.along(0, 0, 0), inner = ring.along(pi, 0, 0);
    const int side = is_upper ? 1 : -1;
    const int band = b.face(ring.surface, {b.loop({side * outer}), b.loop({-side * inner})});
    const int lid =
        b.flat({0, 0, 0}, {0, 0, -1.0 * side}, {1, 0, 0}, {b.loop({-side * outer}), b.loop({side * inner})});
    expect_solid(b.file({b.solid({band, lid})}), 20 * pi * pi + pi * (49 - 9), 20 * pi * pi);
  }
  // The outer half, across the place where angles begin, and the inner one.
  for (const bool is_outer : {true, false}) {
    Ring ring;
    StepBuilder& b = ring.b;
    const int low = ring.along(-pi / 2, 0, 0), high = ring.along(pi / 2, 0, 0);
    const int side = is_outer ? 1 : -1;
    const double area = 4 * pi * (5 * pi + side * 2 * 2);
    expect_area(b.file({b.shell({b.face(ring.surface, {b.loop({side * low}), b.loop({-side * high})})})}), area);
  }
}

}}  // namespace tessera::test
