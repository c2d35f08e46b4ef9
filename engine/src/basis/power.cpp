#include "basis/power.h"

namespace tessera { inline namespace abi_0_1 {

template <class Real>
void power_values(int degree, Real t, Real* values) {
  values[0] = 1;
  if (degree > 0) values[1] = t;
  // A product of halves rounds log2(i) times, not i times.
  for (int i = 2; i <= degree; ++i) values[i] = values[i / 2] * values[i - i / 2];
}

template <class Real>
void power_derivatives(int degree, Real t, Real* values) {
  if (degree > 0) power_values(degree - 1, t, values + 1);
  for (int i = 1; i <= degree; ++i) values[i] *= static_cast<Real>(i);
  values[0] = 0;
}

template <class Real>
void power_second_derivatives(int degree, Real t, Real* values) {
  if (degree > 1) power_values(degree - 2, t, values + 2);
  for (int i = 2; i <= degree; ++i) values[i] *= static_cast<Real>(i * (i - 1));
  values[0] = 0;
  if (degree > 0) values[1] = 0;
}

template void power_values(int, double, double*);
template void power_values(int, long double, long double*);
template void power_derivatives(int, double, double*);
template void power_derivatives(int, long double, long double*);
template void power_second_derivatives(int, double, double*);
template void power_second_derivatives(int, long double, long double*);

}}  // namespace tessera::abi_0_1
