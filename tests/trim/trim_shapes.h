#pragma once
// Loops for the tests of trimmed faces.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include "support/synthetic_sets.h"
#include "tessera/trim_loop.h"
#include "trim/loop_pieces.h"

namespace tessera::test {

/// A polygon of one polyline, closed.
inline TrimLoop polyline(std::vector<ParameterPoint> corners, bool hole = false) {
  corners.push_back(corners.front());
  std::vector<Vec3> points;
  std::vector<double> knots{0};
  for (std::size_t k = 0; k < corners.size(); ++k) {
    points.push_back({corners[k].u, corners[k].v, 0});
    knots.push_back(static_cast<double>(k));
  }
  knots.push_back(knots.back());
  return {{value_of(Curve::b_spline(1, points, knots))}, hole};
}

/// A straight line.
inline Curve line(const ParameterPoint& a, const ParameterPoint& b) {
  return value_of(Curve::bezier(std::vector<Vec3>{{a.u, a.v, 0}, {b.u, b.v, 0}}));
}

/// A polygon of a line per side.
inline TrimLoop polygon(const std::vector<ParameterPoint>& corners, bool hole = false) {
  TrimLoop loop{{}, hole};
  for (std::size_t k = 0; k < corners.size(); ++k)
    loop.curves.push_back(line(corners[k], corners[(k + 1) % corners.size()]));
  return loop;
}

inline TrimLoop rectangle(double u0, double u1, double v0, double v1, bool hole = false) {
  return polygon({{u0, v0}, {u1, v0}, {u1, v1}, {u0, v1}}, hole);
}

/// An ellipse with its axes along u and v, as a rational quadratic of four arcs.
inline TrimLoop ellipse(const ParameterPoint& centre, double radius_u, double radius_v, bool hole = false) {
  constexpr double x[] = {1, 1, 0, -1, -1, -1, 0, 1, 1}, y[] = {0, 1, 1, 1, 0, -1, -1, -1, 0};
  std::vector<Vec3> points;
  std::vector<double> weights;
  for (int k = 0; k < 9; ++k) {
    points.push_back({centre.u + radius_u * x[k], centre.v + radius_v * y[k], 0});
    weights.push_back(k % 2 == 0 ? 1 : std::sqrt(0.5));
  }
  return {{value_of(Curve::nurbs(2, points, weights, std::vector<double>{0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4}))}, hole};
}
inline TrimLoop circle(const ParameterPoint& centre, double radius, bool hole = false) {
  return ellipse(centre, radius, radius, hole);
}

/// A closed spline of random degree, points in [0, 1]^2 and, every other time, weights; it crosses itself often.
inline TrimLoop random_loop(std::mt19937& random, int most_points = 12) {
  std::uniform_real_distribution<double> uniform(0, 1);
  const int degree = 1 + static_cast<int>(random() % 5);
  const int count = degree + 2 + static_cast<int>(random() % static_cast<unsigned>(most_points));
  std::vector<Vec3> points;
  std::vector<double> weights, knots(static_cast<std::size_t>(degree) + 1, 0.0);
  for (int k = 0; k < count; ++k) {
    points.push_back({0.05 + 0.9 * uniform(random), 0.05 + 0.9 * uniform(random), 0});
    weights.push_back(std::exp(3 * uniform(random) - 1.5));
  }
  points.back() = points.front();
  for (int k = 1; k < count - degree; ++k) knots.push_back(knots.back() + 0.1 + uniform(random));
  knots.insert(knots.end(), static_cast<std::size_t>(degree) + 1, knots.back() + 1);
  if (random() % 2 == 0) return {{value_of(Curve::nurbs(degree, points, weights, knots))}};
  return {{value_of(Curve::b_spline(degree, points, knots))}};
}

inline LoopPieces pieces_of(const TrimLoop& loop, std::uint32_t index, const CutLines& lines) {
  CurveExtractions extractions;
  return value_of(loop_pieces(loop, index, lines, extractions));
}

}  // namespace tessera::test
