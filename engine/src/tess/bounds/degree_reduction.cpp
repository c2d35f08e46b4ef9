#include "tess/bounds/degree_reduction.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include "base/infinity.h"
#include "basis/bernstein.h"
#include "basis/small_matrix.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// The coefficients of a higher degree, from those of a lower one (Farin, Curves and Surfaces for CAGD, 5th ed., sec.
/// 6.2).
Matrix raising(int from, int to) {
  Matrix made(to + 1, from + 1);
  for (int i = 0; i <= to; ++i)
    for (int j = 0; j <= from; ++j)
      made(i, j) = static_cast<long double>(binomial(from, j)) * binomial(to - from, i - j) / binomial(to, i);
  return made;
}

Matrix transpose(const Matrix& of) {
  Matrix made(of.columns(), of.rows());
  for (int i = 0; i < of.rows(); ++i)
    for (int j = 0; j < of.columns(); ++j) made(j, i) = of(i, j);
  return made;
}

std::vector<double> entries(const Matrix& of) {
  std::vector<double> made;
  for (int i = 0; i < of.rows(); ++i)
    for (int j = 0; j < of.columns(); ++j) made.push_back(static_cast<double>(of(i, j)));
  return made;
}

/// Writes the product of a, `[rows][inner]`, and b, `[inner][columns]`.
void multiply(const double* a, const double* b, int rows, int inner, int columns, double* to) {
  for (int i = 0; i < rows; ++i) {
    double* const row = to + i * columns;
    std::fill_n(row, columns, 0.0);
    for (int k = 0; k < inner; ++k) {
      const double factor = a[i * inner + k];
      for (int j = 0; j < columns; ++j) row[j] += factor * b[k * columns + j];
    }
  }
}

}  // namespace

DegreeReduction::DegreeReduction(int from, int to) : from_(from), to_(to) {
  const Matrix raise = raising(to, from), across = transpose(raise);
  const std::optional<Matrix> solved = inverse(across * raise);
  const Matrix lower = solved ? *solved * across : Matrix(to + 1, from + 1);  // zero is far from all, and says so
  lower_ = entries(lower), lower_across_ = entries(transpose(lower));
  raise_ = entries(raise), raise_across_ = entries(across);
}

// Sums of up to 45 products, twice, of entries that add up to 1 in each row of raise_: rounding is far below 2^-40 of
// the largest number in the lower net.
double NetReduction::apply(const double* net, double* lower, double* room) const {
  const int rows = u_.from() + 1, columns = v_.from() + 1, low_rows = u_.to() + 1, low_columns = v_.to() + 1;
  double* const half = room;
  double* const raised = room + static_cast<std::ptrdiff_t>(rows) * columns;
  multiply(u_.lower_.data(), net, low_rows, rows, columns, half);
  multiply(half, v_.lower_across_.data(), low_rows, columns, low_columns, lower);
  multiply(u_.raise_.data(), lower, rows, low_rows, low_columns, half);
  multiply(half, v_.raise_across_.data(), rows, low_columns, columns, raised);
  double most = 0, size = 0;
  for (int k = 0; k < rows * columns; ++k) most = std::max(most, std::abs(raised[k] - net[k]));
  for (int k = 0; k < low_rows * low_columns; ++k) size = std::max(size, std::abs(lower[k]));
  const double bound = most + 0x1p-40 * size;
  return std::isfinite(bound) ? bound : infinity;
}

}}  // namespace tessera::abi_0_1
