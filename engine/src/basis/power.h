#pragma once
// Monomials t^i and their derivatives, all up to one degree at one parameter.

namespace tessera { inline namespace abi_0_1 {

// Each function writes degree + 1 values, i = 0..degree, for degree >= 0 and any finite t; 0^0 = 1. Real is double or
// long double.

/// Writes t^i.
template <class Real>
void power_values(int degree, Real t, Real* values);
/// Writes i t^(i-1).
template <class Real>
void power_derivatives(int degree, Real t, Real* values);
/// Writes i (i-1) t^(i-2).
template <class Real>
void power_second_derivatives(int degree, Real t, Real* values);

}}  // namespace tessera::abi_0_1
