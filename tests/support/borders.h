#pragma once
// Borders of ruled surfaces and Coons patches, and the formulas of these in long double.

#include <functional>
#include <utility>
#include <vector>

#include "support/random_splines.h"
#include "tessera/convert.h"
#include "tessera/coons_patch.h"

namespace tessera::test {

inline ParametricCurve callable(std::function<Vec3(double)> position, const Interval& interval = {}) {
  return value_of(ParametricCurve::make({.position = std::move(position)}, interval));
}

/// a + b t + c t^2 on [0,1] as a Bezier curve of degree 2.
inline Curve quadratic(const Vec3& a, const Vec3& b, const Vec3& c) {
  return value_of(Curve::bezier(std::vector<Vec3>{a, a + 0.5 * b, a + b + c}));
}

/// A clamped curve from `from` to `to` over an interval, with `inner` simple knots.
inline Curve curve_between(Random& random, int degree, int inner, bool rational, const Vec3& from, const Vec3& to,
                           const Interval& interval = {}) {
  std::vector<double> knots(static_cast<std::size_t>(degree) + 1, interval.from);
  for (int k = 1; k <= inner; ++k) {
    const double share = (k + uniform(random, -0.3, 0.3)) / (inner + 1);
    knots.push_back(interval.from + share * (interval.to - interval.from));
  }
  knots.insert(knots.end(), static_cast<std::size_t>(degree) + 1, interval.to);
  std::vector<Vec3> points = random_cloud(random, static_cast<std::size_t>(degree + inner) + 1);
  points.front() = from;
  points.back() = to;
  if (!rational) return value_of(Curve::b_spline(degree, points, knots));
  return value_of(Curve::nurbs(degree, points, random_positive(random, points.size(), 0.5, 2), knots));
}

/// The properties of a border of random_borders().
struct BorderStyle {
  int degree = 3, inner = 0;
  bool rational = false;
};

/// Four curves that close, in the order C1, C2, D1, D2.
inline CoonsBorders random_borders(Random& random, const std::array<BorderStyle, 4>& styles,
                                   const Domain& domain = {}) {
  const Vec3 r00 = uniform_vector(random, -1, 1), r01 = uniform_vector(random, -1, 1);
  const Vec3 r10 = uniform_vector(random, -1, 1), r11 = uniform_vector(random, -1, 1);
  const auto curve = [&](const BorderStyle& style, const Vec3& from, const Vec3& to, const Interval& interval) {
    return curve_between(random, style.degree, style.inner, style.rational, from, to, interval);
  };
  const Interval u{domain.u0, domain.u1}, v{domain.v0, domain.v1};
  return {curve(styles[0], r00, r10, u), curve(styles[1], r01, r11, u), curve(styles[2], r00, r01, v),
          curve(styles[3], r10, r11, v)};
}

inline CoonsPatch coons(const CoonsBorders& borders, const CoonsOptions& options = {}) {
  return value_of(CoonsPatch::make(borders, options));
}
inline CoonsPatch coons(const CoonsBorders& borders, const Blend& both) {
  return coons(borders, {.f = both, .g = both});
}

inline RealVec3 real(const Vec3& p) { return {p.x, p.y, p.z}; }
inline RealVec3 reference_position(const BorderCurve& border, Real t) {
  return reference_jet(std::get<Curve>(border), static_cast<double>(t)).position;
}

inline Real reference_blend(std::span<const double> coefficients, Real t) {
  Real sum = 0;
  for (std::size_t i = coefficients.size(); i-- > 0;) sum = sum * t + coefficients[i];
  return sum;
}

/// [C1 C2] g + f^T [D1; D2] - f^T [[r00, r01], [r10, r11]] g, term by term. Borders are exact, blends polynomials.
inline Vec3 reference_position(const CoonsPatch& patch, double u, double v) {
  const Domain d = patch.domain();
  const Real s = (Real(u) - d.u0) / (Real(d.u1) - d.u0), t = (Real(v) - d.v0) / (Real(d.v1) - d.v0);
  const Real f[] = {reference_blend(patch.f().first(), s), reference_blend(patch.f().second(), s)};
  const Real g[] = {reference_blend(patch.g().first(), t), reference_blend(patch.g().second(), t)};
  const CoonsBorders& b = patch.borders();
  RealVec3 sum = g[0] * reference_position(b.c1, u) + g[1] * reference_position(b.c2, u) +
                 f[0] * reference_position(b.d1, v) + f[1] * reference_position(b.d2, v);
  for (int a = 0; a < 2; ++a)
    for (int c = 0; c < 2; ++c) sum = sum - (f[a] * g[c]) * real(patch.corner(a, c));
  return sum.rounded();
}

inline Vec3 reference_position(const RuledSurface& surface, double u, double v) {
  const Domain d = surface.domain();
  const bool along_u = surface.straight() == Direction::v;
  const Real t = along_u ? (Real(v) - d.v0) / (Real(d.v1) - d.v0) : (Real(u) - d.u0) / (Real(d.u1) - d.u0);
  const double along = along_u ? u : v;
  return ((1 - t) * reference_position(surface.first(), along) + t * reference_position(surface.second(), along))
      .rounded();
}

/// A grid's point by the definition of its patch, in long double.
inline Vec3 reference_position(const PatchGrid& grid, double u, double v) {
  const PatchLocation place = grid.locate(u, v).value();
  const Domain d = grid.patch_domain(place.patch);
  return reference_position(grid.patches()[place.patch], (Real(u) - d.u0) / (Real(d.u1) - d.u0),
                            (Real(v) - d.v0) / (Real(d.v1) - d.v0));
}

inline double largest_coefficient(const PatchGrid& grid) {
  double largest = 0;
  for (const BezierPatch& patch : grid.patches()) largest = std::max(largest, largest_coefficient(patch.points()));
  return largest;
}

/// Parameters in every patch, ends and breakpoints included.
inline std::vector<double> parameters_over(std::span<const double> breaks, int count = 5) {
  std::vector<double> parameters{breaks.front()};
  for (std::size_t k = 0; k + 1 < breaks.size(); ++k)
    for (int i = 1; i <= count; ++i)
      parameters.push_back(i == count ? breaks[k + 1] : breaks[k] + i * (breaks[k + 1] - breaks[k]) / count);
  return parameters;
}

/// The largest distance between an exact conversion and the formula, in units of 2^-52 times the largest control value.
template <class Surface>
double conversion_error(const Surface& surface, const PatchGrid& grid) {
  double largest = 0;
  for (const double u : parameters_over(grid.breaks_u()))
    for (const double v : parameters_over(grid.breaks_v())) {
      const double error = max_abs(reference_position(grid, u, v) - reference_position(surface, u, v));
      if (!(error <= largest)) largest = error;  // NaN stays
    }
  return largest / (0x1p-52 * largest_coefficient(grid));
}

/// Whether the points and weights on common borders are equal (by ==).
inline bool shares_borders(const PatchGrid& grid) {
  bool shared = true;
  for (std::size_t a = 0; a < grid.count_u(); ++a)
    for (std::size_t b = 0; b < grid.count_v(); ++b) {
      const BezierPatch& p = grid.patch(a, b);
      for (int j = 0; a + 1 < grid.count_u() && j <= p.degree_v(); ++j) {
        const BezierPatch& q = grid.patch(a + 1, b);
        shared = shared && p.point(p.degree_u(), j) == q.point(0, j) && p.weight(p.degree_u(), j) == q.weight(0, j);
      }
      for (int i = 0; b + 1 < grid.count_v() && i <= p.degree_u(); ++i) {
        const BezierPatch& q = grid.patch(a, b + 1);
        shared = shared && p.point(i, p.degree_v()) == q.point(i, 0) && p.weight(i, p.degree_v()) == q.weight(i, 0);
      }
    }
  return shared;
}

}  // namespace tessera::test
