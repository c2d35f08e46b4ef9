#include "basis/power.h"

namespace tessera {

void power_values(int degree, double t, double* values) {
  values[0] = 1;
  if (degree > 0) values[1] = t;
  // Products of halves round log2(i) times, not i times.
  for (int i = 2; i <= degree; ++i) values[i] = values[i / 2] * values[i - i / 2];
}

void power_derivatives(int degree, double t, double* values) {
  if (degree > 0) power_values(degree - 1, t, values + 1);
  for (int i = 1; i <= degree; ++i) values[i] *= i;
  values[0] = 0;
}

}  // namespace tessera
