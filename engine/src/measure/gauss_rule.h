#pragma once
// Gauss rules on [0, 1], and a bound of their error for analytic functions.

#include <array>

#include "base/internal_export.h"

namespace tessera { inline namespace abi_0_1 {

/// The largest number of nodes of a rule.
inline constexpr int max_gauss = 20;

/// Nodes and weights on [0, 1], each rounded once. The rule is exact for degree 2 count - 1.
struct GaussRule {
  int count = 0;
  std::array<double, max_gauss> nodes{}, weights{};
};

/// Returns the rule of `count` nodes, 1 <= count <= max_gauss. Threads: any number of calls at once.
TESSERA_INTERNAL_EXPORT const GaussRule& gauss_rule(int count);

/// Returns the smallest number of nodes, from 2 on, with which the error of the rule is at most `tolerance`, and that
/// bound of the error; 0 nodes if max_gauss do not suffice.
///
/// - `rho` > 1: the function is analytic in the open ellipse with foci at the ends of the interval whose half axes add
///   up to `rho` half intervals (Bernstein ellipse), and `bound` bounds its absolute value there.
///
/// The Chebyshev coefficients are at most 2 bound rho^-k. The rule of n nodes is exact for T_k, k < 2n, and for odd k;
/// for the others both integrals over [-1, 1] add up to at most 2 + 2 / (k^2 - 1) <= 32/15, k >= 4. The sum of these is
/// 64/15 bound rho^-2n / (1 - rho^-2) (Trefethen, Approximation Theory and Approximation Practice, theorem 19.3), and
/// half as much over [0, 1].
struct GaussChoice {
  int count = 0;
  double error = 0;
};
GaussChoice gauss_choice(double bound, double rho, double tolerance);

}}  // namespace tessera::abi_0_1
