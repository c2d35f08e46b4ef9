#pragma once
// Seeded random B-spline curves and surfaces, and their values in long double from the definition: the recursion of Cox
// and de Boor, derivatives by differences of basis functions. Shares nothing with the library.

#include <algorithm>
#include <vector>

#include "support/random_patches.h"
#include "support/reference.h"
#include "support/synthetic_sets.h"
#include "tessera/curve.h"
#include "tessera/nurbs_surface.h"

namespace tessera::test {

/// The properties of a random knot vector.
struct KnotStyle {
  int inner = 3;          ///< distinct inner knots
  bool clamped = true;    ///< multiplicity degree + 1 at the ends, otherwise simple knots beyond the domain
  bool multiple = false;  ///< inner knots have multiplicity 1 to degree
};

/// Steps between distinct knots in [0.3, 1.5).
inline std::vector<double> random_knots(Random& random, int degree, const KnotStyle& style) {
  double t = uniform(random, -3, 3);
  const auto step = [&] { return t += uniform(random, 0.3, 1.5); };
  std::vector<double> knots(static_cast<std::size_t>(degree + 1), t);
  if (!style.clamped)
    for (double& knot : knots) knot = step();
  for (int k = 0; k < style.inner; ++k) {
    const int times = style.multiple ? 1 + static_cast<int>(random() % static_cast<unsigned>(degree)) : 1;
    knots.insert(knots.end(), static_cast<std::size_t>(times), step());
  }
  step();
  for (int k = 0; k <= degree; ++k) knots.push_back(style.clamped || k == 0 ? t : step());
  return knots;
}

inline std::vector<Vec3> random_cloud(Random& random, std::size_t count) {
  std::vector<Vec3> points(count);
  for (Vec3& p : points) p = uniform_vector(random, -1, 1);
  return points;
}
inline std::vector<double> random_positive(Random& random, std::size_t count, double lowest = 0.25,
                                           double highest = 4) {
  std::vector<double> weights(count);
  for (double& w : weights) w = lowest * std::exp(uniform(random, 0, std::log(highest / lowest)));
  return weights;
}

inline Curve random_curve(Random& random, int degree, const KnotStyle& style, bool rational) {
  const std::vector<double> knots = random_knots(random, degree, style);
  const std::size_t count = knots.size() - static_cast<std::size_t>(degree) - 1;
  const std::vector<Vec3> points = random_cloud(random, count);
  if (!rational) return value_of(Curve::b_spline(degree, points, knots));
  return value_of(Curve::nurbs(degree, points, random_positive(random, count), knots));
}

inline BSplineSurface random_surface(Random& random, int degree_u, int degree_v, const KnotStyle& style_u,
                                     const KnotStyle& style_v, bool rational) {
  const std::vector<double> u = random_knots(random, degree_u, style_u), v = random_knots(random, degree_v, style_v);
  const std::size_t count =
      (u.size() - static_cast<std::size_t>(degree_u) - 1) * (v.size() - static_cast<std::size_t>(degree_v) - 1);
  const std::vector<Vec3> points = random_cloud(random, count);
  if (!rational) return value_of(BSplineSurface::polynomial(degree_u, u, degree_v, v, points));
  return value_of(BSplineSurface::rational(degree_u, u, degree_v, v, points, random_positive(random, count)));
}

/// The span of t: from the right, from the left at the end of the domain.
inline std::size_t reference_span(std::span<const double> knots, double t, double to) {
  std::size_t span = 0;
  for (std::size_t k = 0; k + 1 < knots.size(); ++k)
    if (knots[k] < knots[k + 1] && knots[k] <= t && knots[k] < to) span = k;
  return span;
}
/// The derivative of the given order of N_{i,p} at t, taken of the polynomial that it is on the span.
inline Real reference_basis(std::span<const double> knots, std::size_t span, std::size_t i, int p, Real t,
                            int order = 0) {
  if (p == 0) return order == 0 && i == span ? 1 : 0;
  const std::size_t q = static_cast<std::size_t>(p);
  const Real a = Real(knots[i + q]) - knots[i], b = Real(knots[i + q + 1]) - knots[i + 1];
  const int lower = std::max(order - 1, 0);
  const Real left = a > 0 ? reference_basis(knots, span, i, p - 1, t, lower) / a : 0;
  const Real right = b > 0 ? reference_basis(knots, span, i + 1, p - 1, t, lower) / b : 0;
  if (order > 0) return p * (left - right);
  return (t - knots[i]) * left + (knots[i + q + 1] - t) * right;
}

/// N_{i,p} and derivatives of order 0, 1, 2 of the points i that act at t, from the first of them.
struct ReferenceBasis {
  std::size_t first = 0;
  std::vector<Real> values[3];

  ReferenceBasis(std::span<const double> knots, int degree, double t, double to) {
    const std::size_t span = reference_span(knots, t, to);
    first = span - static_cast<std::size_t>(degree);
    for (int order = 0; order < 3; ++order)
      for (std::size_t i = first; i <= span; ++i)
        values[order].push_back(reference_basis(knots, span, i, degree, t, order));
  }
};

inline RealJet quotient(const RealVec3 a[3][3], const Real w[3][3]) {
  RealJet jet;
  jet.position = (1 / w[0][0]) * a[0][0];
  jet.du = (1 / w[0][0]) * (a[1][0] - w[1][0] * jet.position);
  jet.dv = (1 / w[0][0]) * (a[0][1] - w[0][1] * jet.position);
  jet.duu = (1 / w[0][0]) * (a[2][0] - 2 * w[1][0] * jet.du - w[2][0] * jet.position);
  jet.duv = (1 / w[0][0]) * (a[1][1] - w[1][0] * jet.dv - w[0][1] * jet.du - w[1][1] * jet.position);
  jet.dvv = (1 / w[0][0]) * (a[0][2] - 2 * w[0][1] * jet.dv - w[0][2] * jet.position);
  return jet;
}

inline RealJet reference_jet(const BSplineSurface& surface, double u, double v) {
  const ReferenceBasis bu(surface.knots_u(), surface.degree_u(), u, surface.domain().u1);
  const ReferenceBasis bv(surface.knots_v(), surface.degree_v(), v, surface.domain().v1);
  RealVec3 a[3][3];
  Real w[3][3] = {};
  for (int k = 0; k < 3; ++k)
    for (int l = 0; l < 3 - k; ++l)
      for (std::size_t i = 0; i < bu.values[k].size(); ++i)
        for (std::size_t j = 0; j < bv.values[l].size(); ++j) {
          const Vec3& p = surface.point(bu.first + i, bv.first + j);
          const Real factor = bu.values[k][i] * bv.values[l][j] * surface.weight(bu.first + i, bv.first + j);
          a[k][l] = a[k][l] + factor * RealVec3{p.x, p.y, p.z};
          w[k][l] += factor;
        }
  if (!surface.is_rational()) return {a[0][0], a[1][0], a[0][1], a[2][0], a[1][1], a[0][2]};
  return quotient(a, w);
}

/// Position, du and duu are those of the curve.
inline RealJet reference_jet(const Curve& curve, double t) {
  const ReferenceBasis basis(curve.knots(), curve.degree(), t, curve.domain().to);
  RealVec3 a[3][3];
  Real w[3][3] = {};
  for (int k = 0; k < 3; ++k)
    for (std::size_t i = 0; i < basis.values[k].size(); ++i) {
      const Vec3& p = curve.points()[basis.first + i];
      const Real factor = basis.values[k][i] * curve.weight(basis.first + i);
      a[k][0] = a[k][0] + factor * RealVec3{p.x, p.y, p.z};
      w[k][0] += factor;
    }
  if (!curve.is_rational()) return {a[0][0], a[1][0], {}, a[2][0], {}, {}};
  return quotient(a, w);
}

/// The largest |component| of control points, to which errors are relative.
inline double largest_coefficient(std::span<const Vec3> points) {
  double largest = 0;
  for (const Vec3& p : points) largest = std::max(largest, max_abs(p));
  return largest;
}

/// Parameters of the interval: its ends, its knots, and some between.
inline std::vector<double> sample_parameters(Random& random, std::span<const double> knots, double from, double to,
                                             int count) {
  std::vector<double> parameters{from, to};
  for (const double t : knots)
    if (t > from && t < to) parameters.push_back(t);
  for (int k = 0; k < count; ++k) parameters.push_back(uniform(random, from, to));
  return parameters;
}

}  // namespace tessera::test
