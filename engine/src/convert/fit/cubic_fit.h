#pragma once
// Smooth curves followed by cubics.

#include <array>
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
    if (points_.empty()) {
      points_ = {a.point};
      knots_.assign(4, from);
    }
    append(at, is_near, a, b, 0);
  }

  /// Returns the cubics as a spline. Errors: non_finite (samples).
  Result<Curve> curve() && {
    knots_.push_back(knots_.back());
    return Curve::b_spline(3, points_, knots_);
  }

 private:
  static constexpr int max_depth = 12;

  template <class At, class IsNear>
  void append(const At& at, const IsNear& is_near, const CurveSample& a, const CurveSample& b, int depth) {
    const double third = (b.t - a.t) / 3;
    const std::array<Vec3, 4> c{a.point, a.point + third * a.slope, b.point - third * b.slope, b.point};
    const auto cubic = [&](double x) {
      const double y = 1 - x;
      return y * y * y * c[0] + 3 * x * y * y * c[1] + 3 * x * x * y * c[2] + x * x * x * c[3];
    };
    const CurveSample middle = at(0.5 * (a.t + b.t));
    bool fits = is_near(cubic(0.5), middle.point);
    for (const double x : {0.25, 0.75}) fits = fits && is_near(cubic(x), at(a.t + x * (b.t - a.t)).point);
    if (fits || depth == max_depth) {
      points_.insert(points_.end(), c.begin() + 1, c.end());
      knots_.insert(knots_.end(), 3, b.t);
      return;
    }
    append(at, is_near, a, middle, depth + 1);
    append(at, is_near, middle, b, depth + 1);
  }

  std::vector<Vec3> points_;
  std::vector<double> knots_;
};

}}  // namespace tessera::abi_0_1
