#pragma once
// Curves and surfaces from one expression over any type of number: positions in double, derivatives and proven bounds
// of them by the same expression over Taylor series.
//
//   const auto torus = tessera::generic_surface([](auto u, auto v) {
//     using std::cos, std::sin;                       // overloads for series are found by their argument
//     const auto r = 3 + cos(v);
//     return std::array{r * cos(u), r * sin(u), sin(v)};
//   }, {0, 6, 0, 6});
//
// Memory: a curve or surface keeps copies of the expression. Threads: any number of calls at once, if the expression
// allows it.

#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "tessera/detail/interval_number.h"
#include "tessera/detail/taylor.h"
#include "tessera/guard.h"
#include "tessera/parametric_surface.h"

#pragma GCC visibility push(default)
namespace tessera { inline namespace abi_0_1 {

namespace generic {

template <class T>
Vec3 vector_of(const std::array<T, 3>& p, int i, int j) {
  return {p[0].derivative(i, j), p[1].derivative(i, j), p[2].derivative(i, j)};
}

template <class T>
CurveJet curve_jet(const std::array<T, 3>& p) {
  return {vector_of(p, 0, 0), vector_of(p, 1, 0), vector_of(p, 2, 0)};
}

template <class T>
SurfaceJet surface_jet(const std::array<T, 3>& p) {
  return {vector_of(p, 0, 0), vector_of(p, 1, 0), vector_of(p, 0, 1),
          vector_of(p, 2, 0), vector_of(p, 1, 1), vector_of(p, 0, 2)};
}

/// Returns a bound of the length of the k-th derivative.
template <class T>
double length_bound(const std::array<T, 3>& p, int k) {
  IntervalNumber sum = 0;
  for (const T& component : p) sum += square(component.derivative(k));
  return sqrt(sum).magnitude();
}

/// Calls body(order) with the smallest order of series, 4, 8 or 16, that contains derivative k; returns infinity if k
/// > 16.
template <class Body>
double with_order(int k, Body&& body) {
  if (k <= 4) return body(std::integral_constant<int, 4>{});
  if (k <= 8) return body(std::integral_constant<int, 8>{});
  if (k <= 16) return body(std::integral_constant<int, 16>{});
  return std::numeric_limits<double>::infinity();
}

template <int order>
using Bounds = Taylor<IntervalNumber, order, 1>;

template <class F>
CurveFunctions curve_functions(const F& f) {
  using Dual = Taylor<double, 2, 1>;
  CurveFunctions functions;
  functions.position = [f](double t) {
    const std::array<double, 3> p = f(t);
    return Vec3{p[0], p[1], p[2]};
  };
  functions.jet = [f](double t) { return curve_jet<Dual>(f(Dual::variable(t))); };
  functions.derivative_bound = [f](const Interval& part, int k) {
    return with_order(k, [&](auto order) {
      using Series = Bounds<decltype(order)::value>;
      return length_bound<Series>(f(Series::variable({part.from, part.to})), k);
    });
  };
  return functions;
}

template <class F>
SurfaceFunctions surface_functions(const F& f) {
  using Dual = Taylor<double, 2>;
  SurfaceFunctions functions;
  functions.position = [f](double u, double v) {
    const std::array<double, 3> p = f(u, v);
    return Vec3{p[0], p[1], p[2]};
  };
  functions.jet = [f](double u, double v) { return surface_jet<Dual>(f(Dual::variable(u, 0), Dual::variable(v, 1))); };
  functions.derivative_bounds = [f](const Domain& part, int k) {
    const IntervalNumber u(part.u0, part.u1), v(part.v0, part.v1);
    const auto along_u = [&](auto order) {
      using Series = Bounds<decltype(order)::value>;
      return length_bound<Series>(f(Series::variable(u), Series(v)), k);
    };
    const auto along_v = [&](auto order) {
      using Series = Bounds<decltype(order)::value>;
      return length_bound<Series>(f(Series(u), Series::variable(v)), k);
    };
    return std::array<double, 2>{with_order(k, along_u), with_order(k, along_v)};
  };
  return functions;
}

}  // namespace generic

/// Makes the curve c(t) = f(t).
///
/// - `f`: takes T and returns std::array<T, 3>, for double, Taylor<double, 2, 1> and Taylor<IntervalNumber, N, 1>. It
///   uses + - * / and the functions of taylor.h, and no branches. Constants are doubles.
///
/// Errors: those of ParametricCurve::make().
template <class F>
Result<ParametricCurve> generic_curve(const F& f, const Interval& domain = {}) {
  return guarded([&] { return ParametricCurve::make(generic::curve_functions(f), domain); });
}

/// Makes the surface p(u,v) = f(u,v).
///
/// - `f`: as for generic_curve() with two arguments, for double, Taylor<double, 2> and Taylor<IntervalNumber, N, 1>.
///
/// Errors: those of ParametricSurface::make().
template <class F>
Result<ParametricSurface> generic_surface(const F& f, const Domain& domain = {}) {
  return guarded([&] { return ParametricSurface::make(generic::surface_functions(f), domain); });
}

/// Makes the surface p(x,y) = f(x,y) over a disc by its polar map, to which the series apply too. Positions are those
/// of ParametricSurface::over_disc(). Errors: those of over_disc().
template <class F>
Result<ParametricSurface> generic_surface_over_disc(const F& f, const Disc& disc = {}) {
  return guarded([&]() -> Result<ParametricSurface> {
    const Result<PolarMap> map = PolarMap::make(disc);
    if (!map) return map.status();
    const auto polar = [f, map = *map](const auto& rho, const auto& theta) {
      using std::cos;
      using std::sin;
      using T = std::remove_cvref_t<decltype(rho)>;
      if constexpr (std::is_same_v<T, double>) {
        const auto [x, y] = map(rho, theta);
        return f(x, y);
      } else {
        const T r = map.scale() * rho;
        return f(map.disc().x + r * cos(theta), map.disc().y + r * sin(theta));
      }
    };
    return ParametricSurface::make(generic::surface_functions(polar), map->domain());
  });
}

}}  // namespace tessera::abi_0_1
#pragma GCC visibility pop
