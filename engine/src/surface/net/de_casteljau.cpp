#include <algorithm>
#include <array>

#include "surface/net/homogeneous.h"
#include "tessera/bezier_patch.h"

// Farin, Curves and Surfaces for CAGD, 5th ed., sec. 4.2 (curves), 13.3 (rational), 14.1 (bilinear), 14.3 (curve-wise).

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr std::size_t max_points = max_degree + 1;

template <class Point>
using CurveNet = std::array<Point, max_points>;
template <class Point>
using SurfaceNet = std::array<Point, max_points * max_points>;

/// Returns a point of the curve of the first degree + 1 points, and overwrites them.
template <class Point>
Point curve_point(int degree, CurveNet<Point>& net, double t) {
  for (std::size_t last = static_cast<std::size_t>(degree); last > 0; --last)
    for (std::size_t i = 0; i < last; ++i) net[i] = (1 - t) * net[i] + t * net[i + 1];
  return net[0];
}

template <class Point>
Point curve_wise(int degree_u, int degree_v, std::span<const Point> net, double u, double v) {
  const std::size_t row = static_cast<std::size_t>(degree_v) + 1;
  CurveNet<Point> across;
  for (std::size_t j = 0; j < row; ++j) {
    CurveNet<Point> along;
    for (std::size_t i = 0; i <= static_cast<std::size_t>(degree_u); ++i) along[i] = net[i * row + j];
    across[j] = curve_point(degree_u, along, u);
  }
  return curve_point(degree_v, across, v);
}

template <class Point>
Point bilinear(int degree_u, int degree_v, std::span<const Point> from, double u, double v) {
  const std::size_t row = static_cast<std::size_t>(degree_v) + 1;
  SurfaceNet<Point> net;
  std::copy(from.begin(), from.end(), net.begin());
  const int steps = std::min(degree_u, degree_v);
  for (int k = 1; k <= steps; ++k)
    for (std::size_t i = 0; i <= static_cast<std::size_t>(degree_u - k); ++i)
      for (std::size_t j = 0; j <= static_cast<std::size_t>(degree_v - k); ++j) {
        const Point* p = &net[i * row + j];
        net[i * row + j] = (1 - u) * ((1 - v) * p[0] + v * p[1]) + u * ((1 - v) * p[row] + v * p[row + 1]);
      }
  // One curve remains, in the direction of the higher degree.
  const bool along_u = degree_u > degree_v;
  CurveNet<Point> left;
  const int degree = std::max(degree_u, degree_v) - steps;
  for (std::size_t k = 0; k <= static_cast<std::size_t>(degree); ++k) left[k] = net[along_u ? k * row : k];
  return curve_point(degree, left, along_u ? u : v);
}

/// A point and its weight, not multiplied.
struct WeightedPoint {
  Vec3 point;
  double weight = 1;
};

/// Rational de Casteljau (Farin, eq. 13.5): uses ratios of weights, so that the points stay in the hull.
WeightedPoint rational_curve_point(int degree, CurveNet<WeightedPoint>& net, double t) {
  for (std::size_t last = static_cast<std::size_t>(degree); last > 0; --last)
    for (std::size_t i = 0; i < last; ++i) {
      const double before = (1 - t) * net[i].weight, after = t * net[i + 1].weight, weight = before + after;
      net[i] = {(before / weight) * net[i].point + (after / weight) * net[i + 1].point, weight};
    }
  return net[0];
}

}  // namespace

Vec3 de_casteljau(const BezierPatch& patch, double u, double v) {
  if (!patch.is_rational()) return curve_wise(patch.degree_u(), patch.degree_v(), patch.points(), u, v);
  const HomogeneousNet net(patch);
  const std::span<const Homogeneous> points(net.points.data(), net.size());
  return net.absolute(curve_wise(patch.degree_u(), patch.degree_v(), points, u, v).project());
}

Vec3 de_casteljau_bilinear(const BezierPatch& patch, double u, double v) {
  if (!patch.is_rational()) return bilinear(patch.degree_u(), patch.degree_v(), patch.points(), u, v);
  const HomogeneousNet net(patch);
  const std::span<const Homogeneous> points(net.points.data(), net.size());
  return net.absolute(bilinear(patch.degree_u(), patch.degree_v(), points, u, v).project());
}

Vec3 de_casteljau_rational(const BezierPatch& patch, double u, double v) {
  const HomogeneousNet scaled(patch);  // for its weights
  CurveNet<WeightedPoint> across;
  for (int j = 0; j <= patch.degree_v(); ++j) {
    CurveNet<WeightedPoint> along;
    for (int i = 0; i <= patch.degree_u(); ++i)
      along[static_cast<std::size_t>(i)] = {patch.point(i, j), scaled.at(i, j).w};
    across[static_cast<std::size_t>(j)] = rational_curve_point(patch.degree_u(), along, u);
  }
  return rational_curve_point(patch.degree_v(), across, v).point;
}

}}  // namespace tessera::abi_0_1
