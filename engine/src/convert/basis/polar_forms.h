#pragma once
// Power coefficients to Bernstein coefficients on any interval, in double-double because the sums cancel. Control value
// k of degree n on [a, b] is the polar form at n - k times a and k times b. The polar form of t^i is the elementary
// symmetric polynomial e_i of these arguments over C(n, i) (Ramshaw, Blossoms are polar forms, 1989).

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "basis/bernstein.h"
#include "basis/double_double.h"
#include "tessera/bezier_patch.h"

namespace tessera { inline namespace abi_0_1 {

using PolarForms = std::array<DoubleDouble, max_degree + 1>;

/// Returns the polar forms of t^0 .. t^degree for control value k.
inline PolarForms polar_forms(int degree, int k, double a, double b) {
  PolarForms e{};
  e[0] = {1, 0};
  for (int argument = 0; argument < degree; ++argument) {
    const double t = argument < degree - k ? a : b;
    for (int i = argument + 1; i > 0; --i) {
      const auto at = static_cast<std::size_t>(i);
      e[at] = e[at] + e[at - 1] * t;
    }
  }
  for (int i = 0; i <= degree; ++i)
    e[static_cast<std::size_t>(i)] = e[static_cast<std::size_t>(i)] / binomial(degree, i);
  return e;
}

/// Returns the Bernstein coefficients on [a, b] of the polynomial sum_i coefficients[i] t^i, of degree
/// coefficients.size() - 1.
inline std::vector<long double> bernstein_coefficients(std::span<const double> coefficients, double a, double b) {
  const int degree = static_cast<int>(coefficients.size()) - 1;
  std::vector<long double> values;
  for (int k = 0; k <= degree; ++k) {
    const PolarForms forms = polar_forms(degree, k, a, b);
    DoubleDouble sum;
    for (std::size_t i = 0; i < coefficients.size(); ++i) sum = sum + forms[i] * coefficients[i];
    values.push_back(static_cast<long double>(sum.high) + sum.low);
  }
  return values;
}

}}  // namespace tessera::abi_0_1
