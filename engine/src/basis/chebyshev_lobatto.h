#pragma once
// Polynomial interpolation at Chebyshev-Lobatto parameters, which hold both ends and whose error is nearly the least.

#include <span>
#include <vector>

#include "basis/small_matrix.h"

namespace tessera::inline abi_0_1 {

/// x_i = sin^2(pi i / (2 n)), i = 0..n, n >= 1: the extrema of the Chebyshev polynomial on [0,1]. Increasing, symmetric
/// to rounding, 0 and 1 exact.
std::vector<double> lobatto_parameters(int n);
/// x_i of [a,b]: its ends exactly.
double lobatto_parameter(std::span<const double> parameters, std::size_t i, double a, double b);

/// From values at x_0..x_n to the Bernstein coefficients of the polynomial through them. The first and the last row are
/// exactly those of the identity, so that ends stay ends.
Matrix lobatto_to_bernstein(int n);
/// How far rounding may move a coordinate of a tensor-product patch made by this matrix in both directions: of values
/// at most `largest_value`, into control points at most `largest_point` (Higham, Accuracy and Stability of Numerical
/// Algorithms, 2nd ed., ch. 3, for the inner products). With A the matrix as it came out, B the collocation matrix and
/// A B = I + E, the points of A F A^T are (I + E) P (I + E)^T for the exact P, and the products add (n + 2) roundings
/// of long doubles each.
double lobatto_to_bernstein_rounding(int n, double largest_value, double largest_point);
/// From values at x_0..x_n to those at `parameters` of the polynomial through them.
Matrix lobatto_evaluation(int n, std::span<const double> parameters);

/// |f - If| <= factor h^(n+1) max |f^(n+1)| on an interval of length h: |prod (x - x_i)| / (n+1)! <= 4^-n / (n+1)!, for
/// on [-1,1] the product is sin(t) sin(n t) / 2^(n-1), x = cos t (Trefethen, Approximation Theory and Approximation
/// Practice, ch. 11, for the formula of the error). For vectors too: f - If is the product times a mean of f^(n+1) /
/// (n+1)!.
double lobatto_error_factor(int n);
/// |If| <= constant max |f(x_i)|: 1 + (2/pi) log(n + 1) (the same, thm. 15.2).
double lobatto_lebesgue_constant(int n);

}  // namespace tessera::inline abi_0_1
