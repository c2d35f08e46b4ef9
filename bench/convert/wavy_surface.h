#pragma once
// A surface of many spans for timing conversions.

#include <cmath>
#include <vector>

#include "tessera/nurbs_surface.h"

namespace tessera::bench {

/// spans x spans rectangles between knots 0, 1, 2 .. in both directions, clamped ends, gentle waves of height 1.
inline Result<BSplineSurface> wavy_surface(int spans, int degree, bool rational) {
  std::vector<double> knots(static_cast<std::size_t>(degree), 0.0);
  for (int k = 0; k <= spans; ++k) knots.push_back(k);
  knots.insert(knots.end(), static_cast<std::size_t>(degree), spans);
  std::vector<Vec3> points;
  std::vector<double> weights;
  for (int i = 0; i < spans + degree; ++i)
    for (int j = 0; j < spans + degree; ++j) {
      points.push_back({1.0 * i, 1.0 * j, std::sin(0.1 * i) * std::cos(0.2 * j)});
      weights.push_back(1 + 0.5 * std::sin(1.0 * i * j));
    }
  if (!rational) return BSplineSurface::polynomial(degree, knots, degree, knots, points);
  return BSplineSurface::rational(degree, knots, degree, knots, points, weights);
}

}  // namespace tessera::bench
