#include "basis/bernstein.h"

#include <algorithm>

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Replaces values[0..degree] by factor * (v_{i-1} - v_i), one value more.
template <class Real>
void difference_and_scale(int degree, Real factor, Real* values) {
  values[degree + 1] = factor * values[degree];
  for (int i = degree; i > 0; --i) values[i] = factor * (values[i - 1] - values[i]);
  values[0] *= -factor;
}

}  // namespace

double binomial(int n, int k) {
  if (k < 0 || k > n) return 0;
  double value = 1;
  for (int i = 1; i <= std::min(k, n - k); ++i) value = value * (n - i + 1) / i;  // each quotient is C(n, i)
  return value;
}

// The recurrence B_{i,k} = (1-t) B_{i,k-1} + t B_{i-1,k-1} (Farin, Curves and Surfaces for CAGD, 5th ed., eq. 5.2).
template <class Real>
void bernstein_values(int degree, Real t, Real* values) {
  const Real s = 1 - t;
  values[0] = 1;
  for (int k = 1; k <= degree; ++k) {
    values[k] = t * values[k - 1];
    for (int i = k - 1; i > 0; --i) values[i] = s * values[i] + t * values[i - 1];
    values[0] *= s;
  }
}

// The derivatives are differences of the polynomials of lower degree (Farin, sec. 5.3).
template <class Real>
void bernstein_derivatives(int degree, Real t, Real* values) {
  if (degree < 1) {
    std::fill_n(values, degree + 1, Real{0});
    return;
  }
  bernstein_values(degree - 1, t, values);
  difference_and_scale(degree - 1, static_cast<Real>(degree), values);
}

template <class Real>
void bernstein_second_derivatives(int degree, Real t, Real* values) {
  if (degree < 2) {
    std::fill_n(values, degree + 1, Real{0});
    return;
  }
  bernstein_derivatives(degree - 1, t, values);
  difference_and_scale(degree - 1, static_cast<Real>(degree), values);
}

template void bernstein_values(int, double, double*);
template void bernstein_values(int, long double, long double*);
template void bernstein_derivatives(int, double, double*);
template void bernstein_derivatives(int, long double, long double*);
template void bernstein_second_derivatives(int, double, double*);
template void bernstein_second_derivatives(int, long double, long double*);

}}  // namespace tessera::abi_0_1
