#pragma once
// The parameter of a curve at which it is nearest to a point: by samples, then Newton's method.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "exact/spline_jets.h"
#include "exact/spline_line.h"
#include "tessera/curve.h"
#include "tessera/geometry.h"

namespace tessera { inline namespace abi_0_1 {

/// Parameters of samples of a curve: some in each knot interval of its domain, and both ends.
inline std::vector<double> sample_parameters(const Curve& curve, int samples_per_interval) {
  const std::vector<double> breaks = breaks_of(curve.knots(), curve.domain());
  std::vector<double> out{breaks.front()};
  for (std::size_t k = 0; k + 1 < breaks.size(); ++k)
    for (int i = 1; i <= samples_per_interval; ++i)
      out.push_back(i == samples_per_interval ? breaks[k + 1]
                                              : breaks[k] + i * (breaks[k + 1] - breaks[k]) / samples_per_interval);
  return out;
}

/// Goes from a parameter to where the distance from p has a local minimum within `range`, by steps of Gauss and Newton
/// that are halved until the distance falls. Ends after 40 steps.
///
/// - `at`: the CurvePlace of a parameter.
template <class At>
double refined_foot(const At& at, const Vec3& p, const Interval& range, double t) {
  CurvePlace place = at(t);
  double distance = length(place.point - p);
  for (int step = 0; step < 40; ++step) {
    const double speed = dot(place.slope, place.slope);
    if (!(speed > 0)) break;
    double move = dot(p - place.point, place.slope) / speed;
    bool better = false;
    for (int half = 0; half < 8 && !better; ++half, move *= 0.5) {
      const double next = std::clamp(t + move, range.from, range.to);
      if (next == t) return t;
      const CurvePlace there = at(next);
      const double farther = length(there.point - p);
      if (!(farther < distance)) continue;
      better = true, t = next, place = there, distance = farther;
    }
    if (!better || std::abs(move) <= 1e-15 * (range.to - range.from)) break;
  }
  return t;
}

/// The foot of p, from the nearest of several samples. `points`: the points at `parameters`, at least one.
template <class At>
double nearest_foot(const At& at, const Vec3& p, const Interval& range, std::span<const double> parameters,
                    std::span<const Vec3> points) {
  std::size_t best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < points.size(); ++k)
    if (const double d = length(points[k] - p); d < least) least = d, best = k;
  return refined_foot(at, p, range, parameters[best]);
}

}}  // namespace tessera::abi_0_1
