// Cubics that follow a curve over several intervals: few of them, and near.

#include "convert/fit/cubic_fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

namespace tessera::test { namespace {

using Curve3 = std::function<CurveSample(double)>;

/// The cubics over intervals of a parameter from 0 to 1, within a tolerance. The intervals have unequal lengths, unless
/// `power` is 1.
Curve fitted(const Curve3& at, int intervals, double tolerance, double power = 1.5) {
  std::vector<CurveSample> samples;
  const auto end = [&](int k) { return std::pow(double(k) / intervals, power); };
  for (int k = 0; k < intervals; ++k) {
    samples.push_back(at(end(k)));
    samples.push_back(at(0.5 * (end(k) + end(k + 1))));
  }
  samples.push_back(at(1));
  const auto is_near = [&](const Vec3& a, const Vec3& b) { return length(a - b) <= tolerance; };
  CubicFit fit;
  fit.follow(at, is_near, samples);
  const Result<Curve> made = std::move(fit).curve();
  EXPECT_TRUE(made);
  return *made;
}

std::size_t pieces(const Curve& curve) { return (curve.points().size() - 1) / 3; }

TEST(CubicFit, ACubicOverManyIntervalsIsOne) {
  const Curve3 cubic = [](double t) { return CurveSample{t, {t, t * t, 1 - t * t * t}, {1, 2 * t, -3 * t * t}}; };
  EXPECT_EQ(pieces(fitted(cubic, 1, 1e-12)), 1u);
  EXPECT_EQ(pieces(fitted(cubic, 2, 1e-12)), 1u);
  EXPECT_EQ(pieces(fitted(cubic, 37, 1e-12)), 1u);
}

TEST(CubicFit, OthersAreFollowedWithinTheTolerance) {
  const Curve3 wave = [](double t) { return CurveSample{t, {t, std::sin(20 * t), 0}, {1, 20 * std::cos(20 * t), 0}}; };
  for (const double tolerance : {1e-2, 1e-4, 1e-6}) {
    std::size_t before = 0;
    for (const int intervals : {1, 7, 64, 400}) {
      const Curve made = fitted(wave, intervals, tolerance);
      double most = 0;
      for (int k = 0; k <= 5000; ++k)
        most = std::max(most, length(evaluate_jet(made, k / 5000.0).position - wave(k / 5000.0).point));
      EXPECT_LE(most, 1.5 * tolerance) << intervals;  // between samples, it may be a little more
      EXPECT_EQ(made.domain(), (Interval{0, 1}));
      if (intervals > 7 && before > 0) {
        EXPECT_LE(pieces(made), 3 * before) << intervals;
      }
      before = pieces(made);
    }
    EXPECT_LT(before, 400u) << tolerance;
  }
}

// Samples at the ends and middles of two intervals find what the quarters of one do.
TEST(CubicFit, IntervalsThatDifferAreKeptApart) {
  const auto bump = [](double t) { return t < 0.5 ? 0 : 64 * (t - 0.5) * (t - 0.5) * (1 - t) * (1 - t); };
  const auto slope = [](double t) { return t < 0.5 ? 0 : 128 * (t - 0.5) * (1 - t) * (1.5 - 2 * t); };
  const Curve3 at = [&](double t) { return CurveSample{t, {t, bump(t), 0}, {1, slope(t), 0}}; };
  const Curve made = fitted(at, 8, 1e-3);
  EXPECT_GT(pieces(made), 1u);
  for (int k = 0; k <= 1000; ++k)
    EXPECT_LE(length(evaluate_jet(made, k / 1000.0).position - at(k / 1000.0).point), 1.5e-3) << k;
}

// The ends and middles of all intervals lie on a straight line, which has the curve's slope at its ends.
TEST(CubicFit, WavesBetweenSamplesAreFollowed) {
  constexpr int intervals = 8;
  const double pi = std::numbers::pi;
  const Curve3 wave = [&](double t) {
    const double along = 2 * pi * intervals * t, share = std::sin(pi * t);
    const double slope = 2 * pi * (intervals * std::cos(along) * share + std::sin(along) * std::cos(pi * t)) * share;
    return CurveSample{t, {t, std::sin(along) * share * share, 0}, {1, slope, 0}};
  };
  const Curve made = fitted(wave, intervals, 1e-3, 1);
  for (int k = 0; k <= 1000; ++k)
    EXPECT_LE(length(evaluate_jet(made, k / 1000.0).position - wave(k / 1000.0).point), 1.5e-3) << k;
}

}}  // namespace tessera::test
