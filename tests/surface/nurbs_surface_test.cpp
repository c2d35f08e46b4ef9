#include "tessera/nurbs_surface.h"

#include <cmath>
#include <limits>

#include "support/random_splines.h"
#include "support/ulp.h"

namespace tessera::test { namespace {

constexpr int steps = 60;

template <class Check>
void at_grid(const BSplineSurface& s, Check check) {
  for (int i = 0; i <= steps; ++i)
    for (int j = 0; j <= steps; ++j) {
      const double u = s.domain().u_at(i / double{steps}), v = s.domain().v_at(j / double{steps});
      check(evaluate_jet(s, u, v), u, v);
    }
}

TEST(NurbsSurface, SpheresAreRound) {
  for (const CircleArcs arcs : {CircleArcs::three, CircleArcs::four})
    for (const double radius : {1.0, 0.37, 1234.5})
      at_grid(value_of(make_nurbs_sphere({}, radius, arcs)), [&](const SurfaceJet& jet, double u, double v) {
        EXPECT_NEAR(length(jet.position), radius, 4 * double_unit * radius) << u << " " << v;
        const Vec3 normal = cross(jet.du, jet.dv);
        if (v > 0 && v < 1) {
          EXPECT_LT(length(normalized(normal) - (1 / radius) * jet.position), 1e-13);
        }
      });
}

TEST(NurbsSurface, ToriAreRound) {
  for (const CircleArcs arcs : {CircleArcs::three, CircleArcs::four})
    for (const auto& [major, minor] : {std::pair{1.0, 0.25}, {3.0, 1.0}, {100.0, 7.3}})
      at_grid(value_of(make_nurbs_torus({}, major, minor, arcs)), [&](const SurfaceJet& jet, double u, double v) {
        const Vec3& p = jet.position;
        // From the middle circle: the rounding is that of the torus's own size.
        const double from_middle = std::hypot(std::hypot(p.x, p.y) - major, p.z);
        EXPECT_NEAR(from_middle, minor, 4 * double_unit * (major + minor)) << u << " " << v;
        const Vec3 middle = (major / std::hypot(p.x, p.y)) * Vec3{p.x, p.y, 0};
        EXPECT_LT(length(normalized(cross(jet.du, jet.dv)) - normalized(p - middle)), 1e-12);
      });
}

TEST(NurbsSurface, CylindersAndConesStandOnTheirAxis) {
  for (const CircleArcs arcs : {CircleArcs::three, CircleArcs::four}) {
    at_grid(value_of(make_nurbs_cylinder({}, 2, 5, arcs)), [](const SurfaceJet& jet, double, double v) {
      EXPECT_NEAR(std::hypot(jet.position.x, jet.position.y), 2, 8 * double_unit);
      EXPECT_NEAR(jet.position.z, 5 * v, 8 * double_unit * 5);
    });
    at_grid(value_of(make_nurbs_cone({}, 2, 0, 5, arcs)), [](const SurfaceJet& jet, double, double v) {
      EXPECT_NEAR(std::hypot(jet.position.x, jet.position.y), 2 * (1 - v), 8 * double_unit);
      EXPECT_NEAR(jet.position.z, 5 * v, 8 * double_unit * 5);
    });
  }
}

TEST(NurbsSurface, AnyAxis) {
  const Axis axis{{1, -2, 3}, {2, 1, 2}, {1, 1, 1}};
  const Vec3 direction = normalized(axis.direction);
  at_grid(value_of(make_nurbs_sphere(axis, 2)), [&](const SurfaceJet& jet, double, double v) {
    EXPECT_NEAR(length(jet.position - axis.origin), 2, 8 * double_unit * 6);
    if (v == 0) {
      EXPECT_LT(length(jet.position - (axis.origin - 2 * direction)), 8 * double_unit * 6);
    }
  });
  at_grid(value_of(make_nurbs_cylinder(axis, 2, 3)), [&](const SurfaceJet& jet, double, double v) {
    EXPECT_NEAR(dot(jet.position - axis.origin, direction), 3 * v, 8 * double_unit * 6);
    EXPECT_NEAR(length(cross(jet.position - axis.origin, direction)), 2, 8 * double_unit * 6);
  });
}

TEST(NurbsSurface, RevolutionKeepsTheDistanceFromTheAxis) {
  Random random(1);
  for (const CircleArcs arcs : {CircleArcs::three, CircleArcs::four})
    for (const bool rational : {false, true}) {
      const Curve profile = random_curve(random, 3, {2, false, true}, rational);
      const Axis axis{{0.1, 0.2, 0.3}, {1, 2, -1}, {0, 1, 0}};
      const Vec3 direction = normalized(axis.direction);
      const BSplineSurface s = value_of(make_surface_of_revolution(profile, axis, arcs));
      EXPECT_EQ(s.domain().v0, profile.domain().from);
      EXPECT_EQ(s.domain().v1, profile.domain().to);
      at_grid(s, [&](const SurfaceJet& jet, double, double v) {
        const Vec3 from = evaluate_jet(profile, v).position - axis.origin, to = jet.position - axis.origin;
        EXPECT_NEAR(dot(to, direction), dot(from, direction), 1e-14);
        EXPECT_NEAR(length(cross(to, direction)), length(cross(from, direction)), 1e-14);
      });
      for (const double v : {profile.domain().from, profile.domain().to})
        EXPECT_LT(length(evaluate_jet(s, 0, v).position - evaluate_jet(s, 1, v).position), 1e-15);
    }
}

TEST(NurbsSurface, PolesAreOnePoint) {
  const BSplineSurface s = value_of(make_nurbs_sphere({}, 0.7));
  for (std::size_t i = 1; i < s.count_u(); ++i) {
    EXPECT_EQ(s.point(i, 0), s.point(0, 0));
    EXPECT_EQ(s.point(i, s.count_v() - 1), s.point(0, s.count_v() - 1));
  }
  for (std::size_t j = 0; j < s.count_v(); ++j) EXPECT_EQ(s.point(0, j), s.point(s.count_u() - 1, j));  // the seam
}

TEST(NurbsSurface, BadInputIsNamed) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(make_nurbs_sphere({}, 0).status().code(), StatusCode::invalid_argument);
  EXPECT_EQ(make_nurbs_sphere({}, -1).status().code(), StatusCode::invalid_argument);
  EXPECT_EQ(make_nurbs_sphere({}, nan).status().code(), StatusCode::non_finite);
  EXPECT_EQ(make_nurbs_torus({}, 1, 1).status().code(), StatusCode::invalid_argument);
  EXPECT_EQ(make_nurbs_torus({}, 1, nan).status().code(), StatusCode::non_finite);
  EXPECT_EQ(make_nurbs_cylinder({}, 1, 0).status().code(), StatusCode::invalid_argument);
  EXPECT_EQ(make_nurbs_cylinder({}, 1, nan).status().code(), StatusCode::non_finite);
  EXPECT_EQ(make_nurbs_cone({}, 0, 0, 1).status().code(), StatusCode::invalid_argument);
  EXPECT_EQ(make_nurbs_cone({}, 1, -1, 1).status().code(), StatusCode::invalid_argument);
  EXPECT_EQ(make_nurbs_circle({{}, {0, 0, 0}, {1, 0, 0}}, 1).status().code(), StatusCode::invalid_argument);
  EXPECT_EQ(make_nurbs_circle({{}, {0, 0, 2}, {0, 0, 1}}, 1).status().code(), StatusCode::invalid_argument);
  EXPECT_EQ(make_nurbs_circle({{nan, 0, 0}, {0, 0, 2}, {1, 0, 0}}, 1).status().code(), StatusCode::non_finite);
}

}}  // namespace tessera::test
