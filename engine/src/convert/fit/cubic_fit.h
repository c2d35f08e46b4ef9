#pragma once
// Smooth curves followed by cubics.

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "tessera/curve.h"
#include "tessera/geometry.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// A place of a curve: its parameter, its point, and the derivative by the parameter.
struct CurveSample {
  double t = 0;
  Vec3 point, slope;
};

/// Cubics in Bezier form, each of which begins where the one before it ends, at the parameters of the curve that they
/// follow.
class CubicFit {
 public:
  /// Follows a curve from `from` to `to`, where the cubics before it end: interpolates point and slope at both ends.
  ///
  /// - `at`: the CurveSample of a parameter.
  /// - `is_near`: whether two points are near enough. Intervals are halved, at most 12 times, until this holds of the
  ///   points at a quarter, a half and three quarters.
  template <class At, class IsNear>
  void follow(const At& at, const IsNear& is_near, double from, double to) {
    const CurveSample a = at(from), b = at(to);
    begin(a);
    append(at, is_near, with_quarters(at, a, at(0.5 * (from + to)), b), 0);
  }
  /// Follows a curve over intervals one after the other, where the cubics before them end. Its slope is continuous
  /// where they meet, so a cubic goes over several of them if the points at all their ends and middles are near, and
  /// those at their quarters, as points and slopes beside them show.
  ///
  /// - `samples`: of the ends and middles of all intervals, 2 for each interval and one more.
  template <class At, class IsNear>
  void follow(const At& at, const IsNear& is_near, std::span<const CurveSample> samples) {
    begin(samples.front());
    const std::size_t count = samples.size() / 2;
    if (count == 1) return append(at, is_near, with_quarters(at, samples[0], samples[1], samples[2]), 0);
    const Cubic cubic(samples.front(), samples.back());
    bool fits = true;
    for (std::size_t k = 0; k < samples.size() && fits; ++k) {  // from the middle, where cubics are often farthest
      const std::size_t other = k % 2 ? count + (k + 1) / 2 : count - k / 2;
      if (other < samples.size()) fits = is_near(cubic.at(samples[other].t), samples[other].point);
    }
    for (std::size_t k = 0; k + 1 < samples.size() && fits; ++k)  // slopes show waves that samples are the zeros of
      fits = is_near(cubic.at(0.5 * (samples[k].t + samples[k + 1].t)), middle(samples[k], samples[k + 1]));
    if (fits) return put(cubic);
    follow(at, is_near, samples.first(2 * (count / 2) + 1));
    follow(at, is_near, samples.subspan(2 * (count / 2)));
  }

  /// Returns the cubics as a spline. Errors: non_finite (samples).
  Result<Curve> curve() && {
    knots_.push_back(knots_.back());
    return Curve::b_spline(3, points_, knots_);
  }

 private:
  static constexpr int max_depth = 12;

  /// The cubic with given points and slopes at its ends.
  struct Cubic {
    double from, to;
    std::array<Vec3, 4> points;

    Cubic(const CurveSample& a, const CurveSample& b) : from(a.t), to(b.t) {
      const double third = (b.t - a.t) / 3;
      points = {a.point, a.point + third * a.slope, b.point - third * b.slope, b.point};
    }
    Vec3 at(double t) const {
      const double x = from < to ? (t - from) / (to - from) : 0, y = 1 - x;
      return y * y * y * points[0] + 3 * x * y * y * points[1] + 3 * x * x * y * points[2] + x * x * x * points[3];
    }
  };

  /// The middle of the cubic between two samples.
  static Vec3 middle(const CurveSample& a, const CurveSample& b) {
    return 0.5 * (a.point + b.point) + (b.t - a.t) / 8 * (a.slope - b.slope);
  }

  template <class At>
  static std::array<CurveSample, 5> with_quarters(const At& at, const CurveSample& a, const CurveSample& middle,
                                                  const CurveSample& b) {
    return {a, at(0.5 * (a.t + middle.t)), middle, at(0.5 * (middle.t + b.t)), b};
  }
  void begin(const CurveSample& start) {
    if (!points_.empty()) return;
    points_ = {start.point};
    knots_.assign(4, start.t);
  }
  void put(const Cubic& cubic) {
    points_.insert(points_.end(), cubic.points.begin() + 1, cubic.points.end());
    knots_.insert(knots_.end(), 3, cubic.to);
  }
  /// `samples`: at the ends and the quarters of an interval.
  template <class At, class IsNear>
  void append(const At& at, const IsNear& is_near, const std::array<CurveSample, 5>& samples, int depth) {
    const auto& [a, low, middle, high, b] = samples;
    const Cubic cubic(a, b);
    const auto fits = [&](const CurveSample& of) { return is_near(cubic.at(of.t), of.point); };
    if (depth == max_depth || (fits(middle) && fits(low) && fits(high))) return put(cubic);
    append(at, is_near, with_quarters(at, a, low, middle), depth + 1);
    append(at, is_near, with_quarters(at, middle, high, b), depth + 1);
  }

  std::vector<Vec3> points_;
  std::vector<double> knots_;
};

}}  // namespace tessera::abi_0_1
