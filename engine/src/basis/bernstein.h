#pragma once
// Bernstein polynomials B_{i,n}(t) = C(n,i) t^i (1-t)^(n-i) and their derivatives, all of one degree at one parameter.

namespace tessera { inline namespace abi_0_1 {

/// Returns C(n, k): exact up to n = 30, 0 for k outside 0..n.
double binomial(int n, int k);

// Each function writes degree + 1 values, i = 0..degree, for degree >= 0 and any finite t. On [0,1] nothing cancels:
// the values B_{i,n} are not negative and have a relative error of at most 3 * degree roundings. Real is double, or
// long double for tables that must be right to the last bit of a double.

/// Writes B_{i,n}(t), exactly 1 and 0 at t = 0 and t = 1.
template <class Real>
void bernstein_values(int degree, Real t, Real* values);
/// Writes d/dt of each: n (B_{i-1,n-1} - B_{i,n-1}).
template <class Real>
void bernstein_derivatives(int degree, Real t, Real* values);
/// Writes d2/dt2 of each: n (n-1) (B_{i-2,n-2} - 2 B_{i-1,n-2} + B_{i,n-2}).
template <class Real>
void bernstein_second_derivatives(int degree, Real t, Real* values);

}}  // namespace tessera::abi_0_1
