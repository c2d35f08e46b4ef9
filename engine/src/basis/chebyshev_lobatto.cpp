#include "basis/chebyshev_lobatto.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>

#include "basis/bernstein.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Returns the matrix B_{j,n}(parameters[i]).
Matrix bernstein_matrix(int n, std::span<const double> parameters) {
  Matrix matrix(static_cast<int>(parameters.size()), n + 1);
  std::vector<long double> values(static_cast<std::size_t>(n + 1));
  for (int i = 0; i < matrix.rows(); ++i) {
    bernstein_values(n, static_cast<long double>(parameters[static_cast<std::size_t>(i)]), values.data());
    for (int j = 0; j <= n; ++j) matrix(i, j) = values[static_cast<std::size_t>(j)];
  }
  return matrix;
}

/// Returns the largest row sum of absolute entries.
double norm(const Matrix& matrix) {
  long double largest = 0;
  for (int i = 0; i < matrix.rows(); ++i) {
    long double sum = 0;
    for (int j = 0; j < matrix.columns(); ++j) sum += std::abs(matrix(i, j));
    largest = std::max(largest, sum);
  }
  return static_cast<double>(largest);
}

}  // namespace

std::vector<double> lobatto_parameters(int n) {
  std::vector<double> parameters(static_cast<std::size_t>(n + 1));
  for (int i = 0; i <= n; ++i) {
    const double sine = std::sin(std::numbers::pi / 2 * std::min(i, n - i) / n);
    parameters[static_cast<std::size_t>(i)] = 2 * i <= n ? sine * sine : 1 - sine * sine;
  }
  return parameters;
}

double lobatto_parameter(std::span<const double> parameters, std::size_t i, double a, double b) {
  if (i + 1 == parameters.size()) return b;
  return a + parameters[i] * (b - a);
}

Matrix lobatto_to_bernstein(int n) {
  const auto matrix = inverse(bernstein_matrix(n, lobatto_parameters(n)));
  assert(matrix);  // the parameters are distinct; far from singular for every degree of a patch
  return *matrix;
}

double lobatto_to_bernstein_rounding(int n, double largest_value, double largest_point) {
  const Matrix matrix = lobatto_to_bernstein(n);
  Matrix residual = matrix * bernstein_matrix(n, lobatto_parameters(n));
  for (int i = 0; i <= n; ++i) residual(i, i) -= 1;
  const double roundings = (n + 2) * static_cast<double>(std::numeric_limits<long double>::epsilon() / 2);
  const double size = norm(matrix), error = norm(residual) + 4 * roundings * size;  // the collocation matrix rounds too
  return (0x1p-53 + 2 * error + error * error) * largest_point + 2 * roundings * size * size * largest_value;
}

Matrix lobatto_evaluation(int n, std::span<const double> parameters) {
  return bernstein_matrix(n, parameters) * lobatto_to_bernstein(n);
}

double lobatto_error_factor(int n) {
  // The factor 1 + 2^-40 exceeds the rounding of the parameters and of this product.
  double factor = 1 + 0x1p-40;
  for (int k = 1; k <= n; ++k) factor /= 4.0 * k;
  return factor / (n + 1);
}

double lobatto_lebesgue_constant(int n) { return 1 + 2 / std::numbers::pi * std::log(n + 1.0); }

}}  // namespace tessera::abi_0_1
