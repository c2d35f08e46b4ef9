// Ruled surfaces: the figures of the lectures, their properties, and errors.

#include "tessera/coons_patch.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "support/borders.h"
#include "support/errors.h"
#include "support/ulp.h"

namespace tessera::test { namespace {

RuledSurface ruled(const BorderCurve& first, const BorderCurve& second, const Interval& across = {},
                   Direction straight = Direction::v) {
  return value_of(RuledSurface::make(first, second, across, straight));
}

TEST(RuledFigures, BetweenCallables) {
  const RuledSurface quarter =
      ruled(callable([](double u) {
              return Vec3{u, std::sin(std::numbers::pi * u / 2), std::cos(std::numbers::pi * u / 2)};
            }),
            callable([](double u) {
              return Vec3{u, u * u, -u / 2};
            }));
  const Vec3 p = value_of(position(quarter, 0.25, 0.75));
  EXPECT_EQ(p.x, 0.25);
  EXPECT_NEAR(p.y, 0.142545858, 5e-10);
  EXPECT_NEAR(p.z, 0.137219883, 5e-10);
  const RuledSurface wave = ruled(callable([](double u) {
                                    return Vec3{u, 0, 4 * u * (1 - u)};
                                  }),
                                  callable([](double u) {
                                    return Vec3{u, 1, std::sin(2 * std::numbers::pi * u)};
                                  }));
  EXPECT_TRUE(within_units(value_of(position(wave, 0.25, 0.75)), {0.25, 0.75, 0.9375}, double_unit, 1));
}

TEST(RuledSurface, InterpolatesItsCurvesInBothDirections) {
  Random random(1);
  const Interval along{-1, 2}, across{3, 5};
  const Curve first = curve_between(random, 3, 2, false, {0, 0, 0}, {1, 0, 0}, along);
  const Curve second = curve_between(random, 2, 1, true, {0, 1, 0}, {1, 1, 1}, along);
  const RuledSurface in_v = ruled(first, second, across), in_u = ruled(first, second, across, Direction::u);
  EXPECT_EQ(in_v.domain(), (Domain{-1, 2, 3, 5}));
  EXPECT_EQ(in_u.domain(), (Domain{3, 5, -1, 2}));
  for (int i = 0; i <= 20; ++i) {
    const double t = -1 + 0.15 * i;
    EXPECT_EQ(value_of(position(in_v, t, 3)), evaluate_jet(first, t).position);
    EXPECT_EQ(value_of(position(in_v, t, 5)), evaluate_jet(second, t).position);
    for (const double w : {3.0, 3.7, 5.0}) {
      const SurfaceJet v = value_of(evaluate_jet(in_v, t, w)), u = value_of(evaluate_jet(in_u, w, t));
      EXPECT_TRUE(within_units(v.position, reference_position(in_v, t, w), double_unit, 8));
      EXPECT_EQ(v.position, value_of(position(in_v, t, w)));
      EXPECT_EQ(u.position, v.position);
      EXPECT_EQ(u.du, v.dv);
      EXPECT_EQ(u.dv, v.du);
      EXPECT_EQ(u.dvv, v.duu);
      EXPECT_EQ(u.duv, v.duv);
      EXPECT_EQ(u.duu, Vec3{});
    }
  }
}

// The derivatives of (u, v) -> ((1 - v) sin u + v u^3, ..) by hand.
TEST(RuledSurface, DerivativesAreThoseOfTheFormula) {
  const auto sine = value_of(
      ParametricCurve::make({.position =
                                 [](double u) {
                                   return Vec3{u, 0, std::sin(u)};
                                 },
                             .jet =
                                 [](double u) {
                                   return CurveJet{{u, 0, std::sin(u)}, {1, 0, std::cos(u)}, {0, 0, -std::sin(u)}};
                                 }}));
  const RuledSurface surface = ruled(sine, quadratic({0, 2, 0}, {1, 0, 0}, {0, 0, 1}), {0, 2});
  const double u = 0.375, v = 0.5, s = 0.75, t = 0.25;
  const SurfaceJet jet = value_of(evaluate_jet(surface, u, v));
  EXPECT_TRUE(within_units(jet.position, {u, 2 * t, s * std::sin(u) + t * u * u}, double_unit, 2));
  EXPECT_TRUE(within_units(jet.du, {1, 0, s * std::cos(u) + 2 * t * u}, double_unit, 2));
  EXPECT_TRUE(within_units(jet.dv, {0, 1, (u * u - std::sin(u)) / 2}, double_unit, 2));
  EXPECT_TRUE(within_units(jet.duu, {0, 0, -s * std::sin(u) + 2 * t}, double_unit, 4));
  EXPECT_TRUE(within_units(jet.duv, {0, 0, (2 * u - std::cos(u)) / 2}, double_unit, 2));
  EXPECT_EQ(jet.dvv, Vec3{});
}

TEST(RuledSurface, Refuses) {
  const Curve line = quadratic({0, 0, 0}, {1, 0, 0}, {});
  const auto shifted = callable([](double u) { return Vec3{u, 1, 0}; }, {0, 2});
  expect_refused(RuledSurface::make(line, shifted), StatusCode::invalid_argument, -1,
                 "the first curve and the second curve are on different intervals, [0, 1] and [0, 2]");
  for (const Interval& across : {Interval{1, 1}, Interval{1, 0}})
    expect_refused(RuledSurface::make(line, line, across), StatusCode::invalid_argument, -1, "along v");
  expect_refused(RuledSurface::make(line, line, {0, not_a_number}, Direction::u), StatusCode::non_finite, -1,
                 "along u");
  expect_refused(RuledSurface::make(line, line, {}, Direction(7)), StatusCode::invalid_argument, -1, "direction");
  expect_refused(position(ruled(line, line), infinity, 0), StatusCode::non_finite, -1, "the parameter is inf");
  expect_refused(evaluate_jet(ruled(line, line), 0, infinity), StatusCode::non_finite, -1, "(u, v) = (0, inf)");
  const auto broken = callable([](double t) { return Vec3{t, t == 0.5 ? not_a_number : 0, 0}; });
  const auto thrower = callable([](double t) { return t == 0.5 ? throw std::runtime_error("hole") : Vec3{t, 1, 0}; });
  expect_refused(position(ruled(line, broken), 0.5, 0.25), StatusCode::non_finite, -1,
                 "the second curve: the curve at t = 0.5");
  expect_refused(evaluate_jet(ruled(thrower, line), 0.5, 0.25), StatusCode::invalid_argument, -1,
                 "the first curve: the curve at t = 0.5 threw: hole");
}

}}  // namespace tessera::test
