#pragma once
// Polynomials in one or two variables on [0,1] as Bernstein coefficients: products, sums, derivatives, halves. Every
// value over [0,1]^2 lies in the hull of the coefficients, so a bound of the coefficients holds everywhere.

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "basis/bernstein.h"

namespace tessera { inline namespace abi_0_1 {

/// The polynomial sum_ij B_{i,degree_u}(u) B_{j,degree_v}(v) values[i * (degree_v + 1) + j]. A curve has degree_v = 0.
/// T is double or Vec3.
template <class T>
struct BernsteinNet {
  BernsteinNet(int m, int n) : degree_u(m), degree_v(n), values(static_cast<std::size_t>((m + 1) * (n + 1))) {}

  std::size_t index(int i, int j) const { return static_cast<std::size_t>(i * (degree_v + 1) + j); }
  const T& at(int i, int j) const { return values[index(i, j)]; }
  T& at(int i, int j) { return values[index(i, j)]; }

  int degree_u, degree_v;
  std::vector<T> values;
};

/// Returns the constant 1 of the given degrees.
inline BernsteinNet<double> bernstein_one(int degree_u, int degree_v) {
  BernsteinNet<double> one(degree_u, degree_v);
  for (double& value : one.values) value = 1;
  return one;
}

/// Returns the product of two polynomials under the bilinear `times`: c_k = sum_i C(m,i) C(n,k-i) / C(m+n,k) a_i
/// b_{k-i} in each direction (Farin, Curves and Surfaces for CAGD, 5th ed., sec. 6.10). The sums are convex
/// combinations, so the rounding error is at most a few units times the degrees of the largest product of coefficients.
template <class A, class B, class Times>
auto product(BernsteinNet<A> a, BernsteinNet<B> b, Times times) {
  const auto scale = [](auto& net) {
    for (int i = 0; i <= net.degree_u; ++i)
      for (int j = 0; j <= net.degree_v; ++j)
        net.at(i, j) = (binomial(net.degree_u, i) * binomial(net.degree_v, j)) * net.at(i, j);
  };
  scale(a);
  scale(b);
  BernsteinNet<decltype(times(a.values[0], b.values[0]))> c(a.degree_u + b.degree_u, a.degree_v + b.degree_v);
  for (int i = 0; i <= a.degree_u; ++i)
    for (int k = 0; k <= b.degree_u; ++k)
      for (int j = 0; j <= a.degree_v; ++j)
        for (int l = 0; l <= b.degree_v; ++l) c.at(i + k, j + l) = c.at(i + k, j + l) + times(a.at(i, j), b.at(k, l));
  for (int i = 0; i <= c.degree_u; ++i)
    for (int j = 0; j <= c.degree_v; ++j)
      c.at(i, j) = (1 / (binomial(c.degree_u, i) * binomial(c.degree_v, j))) * c.at(i, j);
  return c;
}
template <class T>
BernsteinNet<T> operator*(const BernsteinNet<double>& a, const BernsteinNet<T>& b) {
  return product(a, b, [](double x, const T& y) { return x * y; });
}

/// Returns the polynomial with higher degrees.
template <class T>
BernsteinNet<T> elevated(const BernsteinNet<T>& a, int degree_u, int degree_v) {
  if (degree_u == a.degree_u && degree_v == a.degree_v) return a;
  return bernstein_one(degree_u - a.degree_u, degree_v - a.degree_v) * a;
}

template <class T>
BernsteinNet<T> operator-(const BernsteinNet<T>& a, const BernsteinNet<T>& b) {
  const int m = std::max(a.degree_u, b.degree_u), n = std::max(a.degree_v, b.degree_v);
  BernsteinNet<T> result = elevated(a, m, n);
  const BernsteinNet<T> taken = elevated(b, m, n);
  for (std::size_t k = 0; k < result.values.size(); ++k) result.values[k] = result.values[k] - taken.values[k];
  return result;
}

/// Returns d/du; the constant 0 for degree 0.
template <class T>
BernsteinNet<T> derivative_u(const BernsteinNet<T>& a) {
  if (a.degree_u == 0) return BernsteinNet<T>(0, a.degree_v);
  BernsteinNet<T> result(a.degree_u - 1, a.degree_v);
  for (int i = 0; i < a.degree_u; ++i)
    for (int j = 0; j <= a.degree_v; ++j) result.at(i, j) = double(a.degree_u) * (a.at(i + 1, j) - a.at(i, j));
  return result;
}
/// Returns d/dv; the constant 0 for degree 0.
template <class T>
BernsteinNet<T> derivative_v(const BernsteinNet<T>& a) {
  if (a.degree_v == 0) return BernsteinNet<T>(a.degree_u, 0);
  BernsteinNet<T> result(a.degree_u, a.degree_v - 1);
  for (int i = 0; i <= a.degree_u; ++i)
    for (int j = 0; j < a.degree_v; ++j) result.at(i, j) = double(a.degree_v) * (a.at(i, j + 1) - a.at(i, j));
  return result;
}

/// Cuts a curve (degree_v = 0) at 1/2 by de Casteljau's algorithm.
template <class T>
std::pair<BernsteinNet<T>, BernsteinNet<T>> halves(BernsteinNet<T> curve) {
  BernsteinNet<T> left(curve.degree_u, 0);
  for (int last = curve.degree_u; last >= 0; --last) {
    left.at(curve.degree_u - last, 0) = curve.at(0, 0);
    for (int i = 0; i < last; ++i) curve.at(i, 0) = 0.5 * curve.at(i, 0) + 0.5 * curve.at(i + 1, 0);
  }
  return {std::move(left), std::move(curve)};
}

}}  // namespace tessera::abi_0_1
