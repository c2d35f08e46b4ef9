// Sections of random patches against dense samples of the sign of the height.

#include "section/section_checks.h"
#include "support/random_patches.h"

namespace tessera::test { namespace {

/// `bowl`: how much higher the border is than the middle.
BezierPatch random_patch(Random& random, int m, int n, bool rational_weights, double spread, double bowl = 0) {
  std::vector<Vec3> points;
  std::vector<double> weights;
  for (int i = 0; i <= m; ++i)
    for (int j = 0; j <= n; ++j) {
      points.push_back(Vec3{double(i) / m, double(j) / n, 0} + uniform_vector(random, -0.1, 0.1) +
                       Vec3{0, 0, uniform(random, -1, 1)} +
                       bowl * Vec3{0, 0, std::max(std::abs(2.0 * i / m - 1), std::abs(2.0 * j / n - 1)) - 0.5});
      weights.push_back(std::pow(spread, uniform(random, -0.5, 0.5)));
    }
  return rational_weights ? rational(m, n, points, weights) : polynomial(m, n, points);
}

double distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const double squared = dot(b - a, b - a);
  const double share = squared > 0 ? std::clamp(dot(p - a, b - a) / squared, 0.0, 1.0) : 0;
  return length(p - (a + share * (b - a)));
}

double distance_to(const Sections& sections, const Vec3& p) {
  double least = 1e300;
  for (const SectionPolyline& polyline : sections.polylines) {
    const auto points = points_of(sections, polyline);
    for (std::size_t k = 0; k + 1 < points.size(); ++k)
      least = std::min(least, distance_to_segment(p, points[k].position, points[k + 1].position));
    if (polyline.closed) least = std::min(least, distance_to_segment(p, points.back().position, points[0].position));
  }
  for (const SectionContact& contact : sections.contacts) least = std::min(least, length(p - contact.position));
  return least;
}

/// Finds points of the section where a grid of samples changes its sign, by halving alone, and expects each near a
/// polyline. Returns how many there were.
std::size_t expect_no_branch_missed(const PatchSet& set, const Sections& sections, const Plane& plane) {
  constexpr int steps = 96;
  const BezierPatch& patch = set.patch(0);
  std::size_t found = 0;
  const auto height = [&](double u, double v) {
    return dot(plane.normal, de_casteljau_bilinear(patch, u, v)) - plane.offset;
  };
  const auto look = [&](double u0, double v0, double u1, double v1) {
    const bool below = height(u0, v0) < 0;
    if (below == (height(u1, v1) < 0)) return;
    for (int k = 0; k < 50; ++k) {
      const double u = 0.5 * (u0 + u1), v = 0.5 * (v0 + v1);
      ((height(u, v) < 0) == below ? u0 : u1) = u, ((height(u, v) < 0) == below ? v0 : v1) = v;
    }
    ++found;
    EXPECT_LE(distance_to(sections, de_casteljau_bilinear(patch, u0, v0)), sections.planes[0].bound + 1e-9);
  };
  for (int i = 0; i <= steps; ++i)
    for (int j = 0; j < steps; ++j) {
      const double a = double(i) / steps, b = double(j) / steps, c = double(j + 1) / steps;
      look(a, b, a, c);
      look(b, a, c, a);
    }
  return found;
}

/// Moves from the middle of a chord's parameters to the section by Newton's method along the gradient, and expects the
/// point within the bound of the chord.
void expect_bound(const PatchSet& set, const Sections& sections, const Plane& plane) {
  const BezierPatch& patch = set.patch(0);
  for (const SectionPolyline& polyline : sections.polylines) {
    const auto points = points_of(sections, polyline);
    for (std::size_t k = 0; k + 1 < points.size(); ++k) {
      double u = 0.5 * (points[k].u + points[k + 1].u), v = 0.5 * (points[k].v + points[k + 1].v);
      SurfaceJet jet;
      for (int step = 0; step < 20; ++step) {
        jet = evaluate_jet(patch, u, v);
        const double g = dot(plane.normal, jet.position) - plane.offset;
        const double gu = dot(plane.normal, jet.du), gv = dot(plane.normal, jet.dv), square = gu * gu + gv * gv;
        if (square == 0 || std::abs(g) < 1e-15) break;
        u -= g * gu / square, v -= g * gv / square;
      }
      if (u < 0 || u > 1 || v < 0 || v > 1) continue;
      EXPECT_LE(distance_to_segment(jet.position, points[k].position, points[k + 1].position),
                sections.planes[0].bound + 1e-12);
    }
  }
}

TEST(SectionOfRandomFields, NoBranchIsMissed) {
  Random random(20260711);
  std::size_t found = 0, closed = 0, open = 0;
  for (int trial = 0; trial < 120; ++trial) {
    const int m = 1 + trial % 5, n = 1 + trial / 5 % 5;
    const bool is_rational = trial % 3 == 1;
    const PatchSet set = value_of(PatchSet::make(
        std::vector{random_patch(random, m, n, is_rational, trial % 2 ? 4 : 100, trial % 2 == 0 ? 4 : 0)}));
    const Plane plane{normalized(Vec3{0, 0, 1} + uniform_vector(random, -0.5, 0.5)), uniform(random, -0.3, 0.3)};
    const Sections made = value_of(make_section(set, plane, {.tolerance = 1e-3}));
    expect_sound(set, made);
    found += expect_no_branch_missed(set, made, plane);
    expect_bound(set, made, plane);
    for (const SectionPolyline& polyline : made.polylines) {
      ++(polyline.closed ? closed : open);
      if (polyline.closed) continue;
      // An open end lies on the border.
      for (const SectionPoint& end : {points_of(made, polyline).front(), points_of(made, polyline).back()})
        EXPECT_TRUE(end.u == 0 || end.u == 1 || end.v == 0 || end.v == 1) << end.u << ' ' << end.v;
    }
    if (HasFailure()) FAIL() << "trial " << trial;
  }
  EXPECT_GT(found, 5000u);
  EXPECT_GT(closed, 5u);
  EXPECT_GT(open, 50u);
}

TEST(SectionOfRandomFields, ManyPlanesAreThoseOfOneByOne) {
  Random random(7);
  const PatchSet set = value_of(PatchSet::make(std::vector{random_patch(random, 4, 4, false, 1)}));
  std::vector<double> offsets;
  for (int k = 0; k < 101; ++k) offsets.push_back(0.9 - 0.018 * k);
  const Sections all = value_of(make_sections(set, {0, 0, 2}, offsets, {.tolerance = 1e-4}));
  expect_sound(set, value_of(make_sections(set, {0, 0, 1}, offsets, {.tolerance = 1e-4})));
  for (std::size_t k = 0; k < offsets.size(); ++k) {
    EXPECT_EQ(all.planes[k].offset, offsets[k]);
    const Sections one = value_of(make_section(set, {{0, 0, 2}, offsets[k]}, {.tolerance = 1e-4}));
    EXPECT_EQ(one.polylines.size(), all.planes[k].polyline_count);
    EXPECT_NEAR(one.planes[0].length, all.planes[k].length, 1e-3);
  }
}

TEST(SectionOfRandomFields, SmallLoopsAreFound) {
  // A paraboloid's cap of radius 1e-5: no grid of samples would see it.
  const std::vector<Vec3> points{{0, 0, 0.5}, {0, 0.5, 0}, {0, 1, 0.5}, {0.5, 0, 0}, {0.5, 0.5, -0.5},
                                 {0.5, 1, 0}, {1, 0, 0.5}, {1, 0.5, 0}, {1, 1, 0.5}};
  const PatchSet set = value_of(PatchSet::make(std::vector{polynomial(2, 2, points)}));  // z = (x-1/2)^2 + (y-1/2)^2
  const Sections made = value_of(make_section(set, {{0, 0, 1}, 1e-10}, {.tolerance = 1e-7, .contact = 0}));
  ASSERT_EQ(made.polylines.size(), 1u);
  EXPECT_TRUE(made.polylines[0].closed);
  EXPECT_NEAR(made.polylines[0].length, 2 * std::numbers::pi * 1e-5, 1e-6);
}

TEST(SectionOfRandomFields, UnevenWeightsKeepTheBound) {
  Random random(99);
  for (int trial = 0; trial < 12; ++trial) {
    const PatchSet set = value_of(PatchSet::make(std::vector{random_patch(random, 2 + trial % 2, 2, true, 1e9)},
                                                 {.blocks = {.float_bernstein = false, .double_bernstein = true}}));
    const Plane plane{{0, 0, 1}, uniform(random, -0.2, 0.2)};
    const Result<Sections> made = make_section(set, plane, {.tolerance = 1e-2});
    ASSERT_TRUE(made.ok()) << made.status().message();
    EXPECT_LE(made->planes[0].bound, made->tolerance);
    expect_no_branch_missed(set, *made, plane);
  }
}

}}  // namespace tessera::test
