#pragma once
// Polynomial interpolation at Chebyshev-Lobatto parameters, which include both ends and have nearly the least error.

#include <span>
#include <vector>

#include "base/internal_export.h"
#include "basis/small_matrix.h"

namespace tessera { inline namespace abi_0_1 {

/// Returns x_i = sin^2(pi i / (2 n)), i = 0..n, n >= 1: the extrema of the Chebyshev polynomial on [0,1]. They are
/// increasing, symmetric to rounding, and exactly 0 and 1 at the ends.
TESSERA_INTERNAL_EXPORT std::vector<double> lobatto_parameters(int n);
/// Returns x_i mapped to [a,b], exactly a and b at the ends.
double lobatto_parameter(std::span<const double> parameters, std::size_t i, double a, double b);

/// Returns the matrix from values at x_0..x_n to the Bernstein coefficients of the polynomial through them. Its first
/// and last row are exactly those of the identity, so end values are kept.
TESSERA_INTERNAL_EXPORT Matrix lobatto_to_bernstein(int n);
/// Bounds how far rounding may move a coordinate of a tensor-product patch made by this matrix in both directions, from
/// values of at most `largest_value` to control points of at most `largest_point`.
///
/// 1. A is the matrix as computed, B the collocation matrix, F the values, P the exact points, and A B = I + E.
/// 2. The computed points A F A^T are (I + E) P (I + E)^T.
/// 3. The products add (n + 2) roundings of long doubles each (Higham, Accuracy and Stability of Numerical Algorithms,
///    2nd ed., ch. 3, for inner products).
double lobatto_to_bernstein_rounding(int n, double largest_value, double largest_point);
/// Returns the matrix from values at x_0..x_n to values at `parameters` of the polynomial through them.
Matrix lobatto_evaluation(int n, std::span<const double> parameters);

/// Returns the factor in |f - If| <= factor h^(n+1) max |f^(n+1)| on an interval of length h.
///
/// 1. The error is f^(n+1) / (n+1)! times prod (x - x_i) (Trefethen, Approximation Theory and Approximation Practice,
///    ch. 11). For vectors it is the product times a mean of f^(n+1) / (n+1)!, so the bound holds for them too.
/// 2. On [-1,1] the product is sin(t) sin(n t) / 2^(n-1), x = cos t.
/// 3. On [0,1], therefore, |prod (x - x_i)| / (n+1)! <= 4^-n / (n+1)!.
double lobatto_error_factor(int n);
/// Returns the constant in |If| <= constant max |f(x_i)|: 1 + (2/pi) log(n + 1) (Trefethen, thm. 15.2).
double lobatto_lebesgue_constant(int n);

}}  // namespace tessera::abi_0_1
