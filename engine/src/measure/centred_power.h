#pragma once
// Bernstein coefficients on [0, 1] as power coefficients about the middle, from which bounds at complex arguments
// follow: |p(z)| <= sum |a_k| |x|^k with z = (1 + x) / 2.

#include <array>
#include <cstddef>

#include "tessera/bezier_patch.h"

namespace tessera { inline namespace abi_0_1 {

inline constexpr std::size_t max_order = static_cast<std::size_t>(max_degree) + 1;

/// The matrix [k][i] of one degree: a_k = sum_i entry[k][i] b_i. Its entries are exact.
using PowerMatrix = std::array<std::array<double, max_order>, max_order>;

/// Returns the matrix of a degree from 0 to max_degree. Threads: any number of calls at once.
const PowerMatrix& centred_power(int degree);

/// The number of coefficients of a degree.
inline std::size_t count_of(int degree) { return static_cast<std::size_t>(degree) + 1; }

/// Returns the largest |x| in the ellipse with foci -1 and 1 whose half axes add up to rho.
inline double ellipse_reach(double rho) { return 0.5 * (rho + 1 / rho); }

/// Sums of a few hundred numbers round a bound by less than this factor.
inline constexpr double bound_slack = 1 + 1e-12;

}}  // namespace tessera::abi_0_1
