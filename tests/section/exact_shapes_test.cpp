// Sections of shapes that are known in closed form.

#include "section/section_checks.h"

namespace tessera::test { namespace {

PatchSet torus(double large, double small) { return set_of(make_nurbs_torus({}, large, small)); }
PatchSet ball(double radius) { return set_of(make_nurbs_sphere({}, radius)); }

/// The perimeter of an ellipse by the trapezoid rule, which converges geometrically for it.
double perimeter(double a, double b) {
  constexpr int steps = 4096;
  double sum = 0;
  for (int k = 0; k < steps; ++k) {
    const double t = 2 * pi * k / steps;
    sum += std::hypot(a * std::sin(t), b * std::cos(t));
  }
  return sum * 2 * pi / steps;
}

TEST(Section, AnObliqueCutOfACylinderIsAnEllipse) {
  const PatchSet set = turned(line({2, 0, -5}, {2, 0, 5}));
  const Vec3 normal = normalized({0.3, -0.4, 1});
  double before = 1;
  for (const double tolerance : {1e-2, 1e-4, 1e-6}) {
    const Sections made = value_of(make_section(set, {normal, 0.25}, {.tolerance = tolerance}));
    expect_sound(set, made);
    ASSERT_EQ(made.polylines.size(), 1u);
    EXPECT_TRUE(made.polylines[0].closed);
    const double size = set.box().diagonal();
    for (const SectionPoint& point : made.points)
      EXPECT_NEAR(std::hypot(point.position.x, point.position.y), 2, 1e-14 * size);
    // Chords are inside, and each is within the tolerance of an arc: the ellipse is longer by the share of the square.
    const double missing = perimeter(2 / normal.z, 2) - made.polylines[0].length;
    EXPECT_GT(missing, -1e-12);
    EXPECT_LT(missing, 8 * tolerance);
    EXPECT_LT(missing, before / 10);
    before = missing;
  }
}

TEST(Section, TheBoundHoldsOnTheEllipse) {
  const PatchSet set = turned(line({1, 0, -5}, {1, 0, 5}));
  const Vec3 normal = normalized({1, 0, 1});
  const Sections made = value_of(make_section(set, {normal, 0}, {.tolerance = 1e-3}));
  const std::span<const SectionPoint> points = points_of(made, made.polylines.at(0));
  double largest = 0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    // The ellipse is a circle scaled along one axis, so a chord's farthest point is at the middle angle.
    const Vec3 &a = points[k].position, &b = points[(k + 1) % points.size()].position;
    const Vec3 middle = 0.5 * (a + b);
    const double radius = std::hypot(middle.x, middle.y);
    const Vec3 on_curve{middle.x / radius, middle.y / radius, -middle.x / radius};
    const Vec3 along = normalized(b - a);
    largest = std::max(largest, length((on_curve - a) - dot(on_curve - a, along) * along));
  }
  EXPECT_LE(largest, made.planes[0].bound);
  EXPECT_GT(largest, made.planes[0].bound / 16) << "the bound is far too large";
}

TEST(Section, LayersOfABallAreCircles) {
  const PatchSet set = ball(3);
  std::vector<double> offsets;
  for (int k = -29; k < 30; ++k) offsets.push_back(0.1 * k);
  for (const Vec3& normal : {Vec3{0, 0, 1}, Vec3{1, 0, 0}, normalized(Vec3{1, 2, 3}), normalized(Vec3{-3, 0.1, 0.2})}) {
    const Sections made = value_of(make_sections(set, normal, offsets, {.tolerance = 1e-4}));
    expect_sound(set, made);
    ASSERT_EQ(made.planes.size(), offsets.size());
    for (std::size_t k = 0; k < offsets.size(); ++k) {
      ASSERT_EQ(made.planes[k].polyline_count, 1u) << offsets[k];
      const SectionPolyline& circle = made.polylines[made.planes[k].first_polyline];
      EXPECT_TRUE(circle.closed);
      const double radius = std::sqrt(9 - offsets[k] * offsets[k]);
      EXPECT_NEAR(circle.length, 2 * pi * radius, 8e-4);
    }
  }
}

TEST(Section, APlaneThroughThePolesIsOneCircle) {
  const PatchSet set = ball(1);
  for (const double angle : {0.0, 0.3, pi / 2, 2.0}) {
    const Sections made = value_of(make_section(set, {{std::cos(angle), std::sin(angle), 0}, 0}, {.tolerance = 1e-5}));
    expect_sound(set, made);
    ASSERT_EQ(made.polylines.size(), 1u) << angle;
    EXPECT_TRUE(made.polylines[0].closed) << angle;
    EXPECT_NEAR(made.polylines[0].length, 2 * pi, 1e-4);
  }
}

TEST(Section, APlaneThatTouchesABallHasAContact) {
  const PatchSet set = ball(1);
  for (const Vec3& normal :
       {Vec3{0, 0, 1}, Vec3{0, 0, -1}, Vec3{1, 0, 0}, normalized(Vec3{1, 2, 2}), normalized(Vec3{3, 1, -2})}) {
    const Sections made = value_of(make_section(set, {normal, 1}));
    EXPECT_EQ(made.polylines.size(), 0u);
    ASSERT_EQ(made.contacts.size(), 1u);
    EXPECT_EQ(made.contacts[0].kind, SectionContact::Kind::point);
    EXPECT_LE(length(made.contacts[0].position - normal), 2 * made.contact_size);
    EXPECT_EQ(value_of(make_section(set, {normal, 1.001})).contacts.size(), 0u);
  }
}

TEST(Section, ATorusHasTwoCirclesAndVillarceaus) {
  const double large = 3, small = 1;
  const PatchSet set = torus(large, small);
  const Sections flat = value_of(make_section(set, {{0, 0, 1}, 0.5}, {.tolerance = 1e-4}));
  expect_sound(set, flat);
  ASSERT_EQ(flat.polylines.size(), 2u);
  EXPECT_NEAR(flat.planes[0].length, 4 * pi * large, 1e-2);

  const double slope = std::asin(small / large);
  const Sections tilted = value_of(make_section(set, {{-std::sin(slope), 0, std::cos(slope)}, 0}, {.tolerance = 1e-5}));
  expect_sound(set, tilted, 2e-10);
  EXPECT_EQ(tilted.planes[0].open_count, 0u);
  EXPECT_NEAR(tilted.planes[0].length, 4 * pi * large, 1e-3);
  for (const SectionPoint& point : tilted.points) {
    const double first = length(point.position - Vec3{0, small, 0}),
                 second = length(point.position + Vec3{0, small, 0});
    EXPECT_LT(std::min(std::abs(first - large), std::abs(second - large)), tilted.contact_size);
  }
}

TEST(Section, TheInnerTangentPlaneOfATorusIsAnEight) {
  const double large = 3, small = 1;
  const PatchSet set = torus(large, small);
  double before = 0;
  for (const double turn : {0.0, 0.4}) {
    const Vec3 normal{std::cos(turn), std::sin(turn), 0};
    const Sections made = value_of(make_section(set, {normal, large - small}, {.tolerance = 1e-5}));
    expect_sound(set, made, 2e-10);
    EXPECT_EQ(made.planes[0].open_count, 0u);
    ASSERT_GE(made.polylines.size(), 1u);
    ASSERT_LE(made.polylines.size(), 2u);
    ASSERT_GE(made.contacts.size(), 1u);
    EXPECT_LE(length(made.contacts[0].position - (large - small) * normal), 1e-4);
    // The eight is a lemniscate of Booth: (x^2 + z^2)^2 = 4 R r x^2 - 4 ... z^2 in the plane, here by its points.
    for (const SectionPoint& p : made.points) {
      const double q = dot(p.position, p.position) + large * large - small * small;
      const double radial = p.position.x * p.position.x + p.position.y * p.position.y;
      EXPECT_NEAR(q * q, 4 * large * large * radial, 1e-11 * q * q);
    }
    if (before > 0) {
      EXPECT_NEAR(made.planes[0].length, before, 1e-3);
    }
    before = made.planes[0].length;
  }
}

TEST(Section, ATorusOnAPlaneTouchesAlongACircle) {
  const PatchSet set = torus(3, 1);
  const Sections top = value_of(make_section(set, {{0, 0, 1}, 1}, {.tolerance = 1e-4}));
  expect_sound(set, top, 2e-10);
  ASSERT_EQ(top.polylines.size(), 2u) << "the circle is the limit of two";
  for (const SectionPolyline& circle : top.polylines) EXPECT_NEAR(circle.length, 6 * pi, 1e-2);
  for (const SectionPoint& p : top.points) EXPECT_NEAR(std::hypot(p.position.x, p.position.y), 3, 1e-7);
  EXPECT_EQ(value_of(make_section(set, {{0, 0, 1}, 1 + 1e-6})).points.size(), 0u);
}

TEST(Section, AConeThroughItsApexIsTwoLines) {
  const PatchSet set = turned(line({0, 0, 0}, {1, 0, 1}));
  for (const double angle : {0.0, 0.7}) {
    const Sections made = value_of(make_section(set, {{std::sin(angle), -std::cos(angle), 0}, 0}, {.tolerance = 1e-4}));
    expect_sound(set, made);
    ASSERT_EQ(made.polylines.size(), 1u);
    EXPECT_NEAR(made.polylines[0].length, 2 * std::sqrt(2.0), 1e-9);
  }
  const Sections apex = value_of(make_section(set, {{0, 0, 1}, 0}));
  EXPECT_EQ(apex.polylines.size(), 0u);
  ASSERT_EQ(apex.contacts.size(), 1u);
  EXPECT_LE(length(apex.contacts[0].position), apex.contact_size);
  // A plane that is steeper than the cone: a hyperbola, open where the cone ends.
  const Sections steep = value_of(make_section(set, {{1, 0, 0}, 0.25}, {.tolerance = 1e-4}));
  expect_sound(set, steep);
  ASSERT_EQ(steep.polylines.size(), 1u);
  EXPECT_FALSE(steep.polylines[0].closed);
  for (const SectionPoint& p : steep.points)
    EXPECT_NEAR(p.position.z * p.position.z, 0.0625 + p.position.y * p.position.y, 1e-13);
}

TEST(Section, OffsetsFollowANormalOfAnyLength) {
  const PatchSet set = ball(1);
  const Sections unit = value_of(make_section(set, {{0, 0, 1}, 0.5}));
  for (const double scale : {1e-200, 1e-3, 7.0, 1e200}) {
    const Sections scaled = value_of(make_section(set, {{0, 0, scale}, 0.5 * scale}));
    ASSERT_EQ(scaled.points.size(), unit.points.size());
    EXPECT_NEAR(scaled.planes[0].length, unit.planes[0].length, 1e-12);
  }
}

}}  // namespace tessera::test
