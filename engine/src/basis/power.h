#pragma once
// Monomials t^i and their derivatives, all up to one degree at one parameter.

namespace tessera {

// Each writes degree + 1 values, i = 0..degree, of degree >= 0. Any finite t; 0^0 = 1.

/// t^i.
void power_values(int degree, double t, double* values);
/// i t^(i-1).
void power_derivatives(int degree, double t, double* values);

}  // namespace tessera
