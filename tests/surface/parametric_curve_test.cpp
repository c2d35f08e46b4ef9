// Curves that are functions, and errors.

#include "tessera/parametric_surface.h"

#include <cmath>
#include <new>
#include <stdexcept>

#include "support/borders.h"
#include "support/errors.h"
#include "support/ulp.h"
#include "surface/callable/border_curve.h"

namespace tessera::test { namespace {

Vec3 helix(double t) { return {std::cos(t), std::sin(t), 0.5 * t}; }
CurveJet helix_jet(double t) { return {helix(t), {-std::sin(t), std::cos(t), 0.5}, {-std::cos(t), -std::sin(t), 0}}; }

TEST(ParametricCurve, GivesTheCallersDerivatives) {
  const ParametricCurve curve = value_of(ParametricCurve::make({.position = helix, .jet = helix_jet}, {-1, 4}));
  EXPECT_TRUE(curve.has_derivatives());
  const CurveJet jet = value_of(evaluate_jet(curve, 0.7)), expected = helix_jet(0.7);
  EXPECT_EQ(jet.position, expected.position);
  EXPECT_EQ(jet.first, expected.first);
  EXPECT_EQ(jet.second, expected.second);
}

// F = 2, L = 5 and F_k <= 1: bounds of surface/callable/differences.h.
TEST(ParametricCurve, TakesDifferencesWithinItsInterval) {
  const Interval interval{-1, 4};
  const auto guarded_helix = [&](double t) {
    if (t < interval.from || t > interval.to) throw std::out_of_range("outside");
    return helix(t);
  };
  const ParametricCurve curve = callable(guarded_helix, interval);
  EXPECT_FALSE(curve.has_derivatives());
  for (int i = 0; i <= 100; ++i) {
    const double t = interval.from + i * 0.05;
    const CurveJet jet = value_of(evaluate_jet(curve, t)), expected = helix_jet(t);
    EXPECT_EQ(jet.position, expected.position);
    EXPECT_LT(max_abs(jet.first - expected.first), 2e-11);
    EXPECT_LT(max_abs(jet.second - expected.second), 1e-8);
  }
}

TEST(ParametricCurve, NamesTheParameterOfWhatIsNotFinite) {
  const auto broken = [](double t) { return Vec3{t, t > 0.4 && t < 0.6 ? not_a_number : 0, 0}; };
  const ParametricCurve curve = callable(broken);
  EXPECT_TRUE(curve.position(0.25).ok());
  expect_refused(curve.position(0.5), StatusCode::non_finite, -1, "the curve at t = 0.5 is (0.5, nan, 0)");
  expect_refused(evaluate_jet(curve, 0.5), StatusCode::non_finite, -1, "t = 0.5");
  const auto bad_second = [](double t) { return CurveJet{helix(t), {}, {infinity, 0, 0}}; };
  const auto with_jet = value_of(ParametricCurve::make({.position = helix, .jet = bad_second}));
  expect_refused(evaluate_jet(with_jet, 0.25), StatusCode::non_finite, -1, "second derivative at t = 0.25");
}

TEST(ParametricCurve, WhatIsThrownBecomesAStatus) {
  const auto thrower = [](double t) {
    if (t == 0.25) throw std::runtime_error("no such point");
    if (t == 0.5) throw 42;
    if (t == 0.75) throw std::bad_alloc();
    return helix(t);
  };
  const ParametricCurve curve = callable(thrower);
  expect_refused(curve.position(0.25), StatusCode::invalid_argument, -1, "t = 0.25 threw: no such point");
  expect_refused(curve.position(0.5), StatusCode::invalid_argument, -1, "t = 0.5 threw");
  expect_refused(curve.position(0.75), StatusCode::out_of_memory, -1, "memory");
  const auto never = [](double) -> CurveJet { throw std::runtime_error("no derivatives"); };
  const auto with_jet = value_of(ParametricCurve::make({.position = helix, .jet = never}));
  expect_refused(evaluate_jet(with_jet, 0.5), StatusCode::invalid_argument, -1, "no derivatives");
}

TEST(ParametricCurve, Refuses) {
  expect_refused(ParametricCurve::make({}), StatusCode::invalid_argument, -1, "no function");
  for (const Interval& interval : {Interval{1, 1}, Interval{2, 1}})
    expect_refused(ParametricCurve::make({.position = helix}, interval), StatusCode::invalid_argument, -1, "interval");
  for (const Interval& interval : {Interval{0, infinity}, Interval{not_a_number, 1}})
    expect_refused(ParametricCurve::make({.position = helix}, interval), StatusCode::non_finite, -1, "interval");
  const auto inverse = [](double t) { return Vec3{1 / t, 0, 0}; };
  expect_refused(ParametricCurve::make({.position = inverse}), StatusCode::non_finite, -1, "t = 0 ");
}

TEST(ParametricCurve, BoundsAreTheCallersOrInfinite) {
  const auto bound = [](const Interval& part, int k) -> double {
    if (k == 7) throw std::runtime_error("none");
    if (k == 8) return not_a_number;
    return part.to * k;
  };
  const auto curve = value_of(ParametricCurve::make({.position = helix, .derivative_bound = bound}));
  EXPECT_TRUE(curve.has_bounds());
  EXPECT_EQ(curve.derivative_bound({0, 0.5}, 3), 1.5);
  EXPECT_EQ(curve.derivative_bound({0, 0.5}, 7), infinity);
  EXPECT_EQ(curve.derivative_bound({0, 0.5}, 8), infinity);
  EXPECT_EQ(callable(helix).derivative_bound({0, 1}, 0), infinity);
}

// Bounds of polynomial curves hold, and the hull is not far: within a factor of 60 of the largest sampled on cubics.
TEST(BorderCurve, BoundsOfCurvesHold) {
  Random random(1);
  for (int degree = 1; degree <= 7; ++degree) {
    const Curve curve = random_curve(random, degree, {3, degree % 2 == 0}, false);
    const Interval whole = curve.domain();
    const Interval part{whole.from + 0.2 * (whole.to - whole.from), whole.from + 0.7 * (whole.to - whole.from)};
    double largest[3] = {};
    for (int i = 0; i <= 200; ++i) {
      const RealJet jet = reference_jet(curve, part.from + i * (part.to - part.from) / 200);
      largest[0] = std::max(largest[0], length(jet.position.rounded()));
      largest[1] = std::max(largest[1], length(jet.du.rounded()));
      largest[2] = std::max(largest[2], length(jet.duu.rounded()));
    }
    for (int k = 0; k <= std::min(degree, 2); ++k) EXPECT_GE(derivative_bound(BorderCurve(curve), part, k), largest[k]);
    EXPECT_LT(derivative_bound(BorderCurve(curve), part, 0), 60 * largest[0]);
    const double beyond = derivative_bound(BorderCurve(curve), part, degree + 1);
    EXPECT_EQ(beyond, infinity) << "across simple knots the next derivative does not exist";
  }
  const Curve cubic = quadratic({0, 0, 0}, {1, 2, 3}, {3, 0, 4});
  EXPECT_EQ(derivative_bound(BorderCurve(cubic), {0, 1}, 3), 0);
  EXPECT_NEAR(derivative_bound(BorderCurve(cubic), {0, 1}, 2), 10, 1e-10);
}

}}  // namespace tessera::test
