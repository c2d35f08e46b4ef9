#pragma once
// Conversion of Bernstein nets to power coefficients.

#include <span>

namespace tessera { inline namespace abi_0_1 {

/// Turns a Bernstein net [i][j][component] in place into the coefficients of u^i v^j. Rational patches: homogeneous
/// components. net.size() == (degree_u + 1) * (degree_v + 1) * components.
///
/// A = M_u G M_v^T with M_ik = C(n,i) C(i,k) (-1)^(i-k), which is C(n,i) times the i-th forward difference (Farin,
/// Curves and Surfaces for CAGD, 5th ed., sec. 5.8). The result is exact while the differences are, as for small
/// integers. Otherwise the differences cancel, and evaluating the result on [0,1] loses up to 58 / 2,950 / 135,000
/// units in the last place at degrees 3 / 5 / 7. Make the net relative to a near origin first.
void power_coefficients(int degree_u, int degree_v, int components, std::span<double> net);

}}  // namespace tessera::abi_0_1
