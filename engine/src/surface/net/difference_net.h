#pragma once
// Derivatives of a homogeneous net as Bezier patches of lower degree on its difference nets (Farin, Curves and Surfaces
// for CAGD, 5th ed., sec. 14.5). Differences are taken before sums, so small ones stay accurate.

#include <algorithm>

#include "basis/bernstein.h"
#include "surface/net/homogeneous.h"

namespace tessera { inline namespace abi_0_1 {

/// B_{i,n-k}(t) for k = 0, 1, 2: the factors in the sums of the derivatives of order k.
struct LoweredBernstein {
  LoweredBernstein(int n, double t) : degree(n) {
    for (int order = 0; order < 3 && order <= n; ++order) bernstein_values(n - order, t, values[order]);
  }
  int degree;
  double values[3][max_degree + 1];
};

/// Returns the difference of order A along u and B along v at [i][j].
template <int A, int B>
Homogeneous difference(const HomogeneousNet& net, int i, int j) {
  if constexpr (A > 0)
    return difference<A - 1, B>(net, i + 1, j) - difference<A - 1, B>(net, i, j);
  else if constexpr (B > 0)
    return difference<A, B - 1>(net, i, j + 1) - difference<A, B - 1>(net, i, j);
  else
    return net.at(i, j);
}

/// Returns the scale of the rounding of difference<A, B>: the sum of the largest components of the first differences
/// that it is made of.
template <int A, int B>
double spread(const HomogeneousNet& net, int i, int j) {
  if constexpr (A + B == 1)
    return max_abs(difference<A, B>(net, i, j).vector());
  else if constexpr (A > 0)
    return spread<A - 1, B>(net, i + 1, j) + spread<A - 1, B>(net, i, j);
  else
    return spread<A, B - 1>(net, i, j + 1) + spread<A, B - 1>(net, i, j);
}

/// Returns n (n-1) .. with K factors.
template <int K>
double falling_factorial(int n) {
  return K == 0 ? 1 : K == 1 ? n : n * (n - 1);
}

/// Returns the derivative of order A in u and B in v of the four homogeneous components; zero where the degree is too
/// low.
template <int A, int B>
Homogeneous derivative(const HomogeneousNet& net, const LoweredBernstein& u, const LoweredBernstein& v) {
  Homogeneous sum{0, 0, 0, 0};
  for (int i = 0; i <= u.degree - A; ++i) {
    Homogeneous row{0, 0, 0, 0};
    for (int j = 0; j <= v.degree - B; ++j) row = row + v.values[B][j] * difference<A, B>(net, i, j);
    sum = sum + u.values[A][i] * row;
  }
  return falling_factorial<A>(u.degree) * falling_factorial<B>(v.degree) * sum;
}

/// Returns the same sum over spreads. The rounding error of derivative<A, B> is at most a few units times the degrees
/// of this sum.
template <int A, int B>
double derivative_magnitude(const HomogeneousNet& net, const LoweredBernstein& u, const LoweredBernstein& v) {
  double sum = 0;
  for (int i = 0; i <= u.degree - A; ++i)
    for (int j = 0; j <= v.degree - B; ++j) sum += u.values[A][i] * v.values[B][j] * spread<A, B>(net, i, j);
  return falling_factorial<A>(u.degree) * falling_factorial<B>(v.degree) * sum;
}

}}  // namespace tessera::abi_0_1
