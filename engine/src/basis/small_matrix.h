#pragma once
// Small dense matrices in long double, for products and inverses that must be right to the last bits of a double.

#include <optional>
#include <span>
#include <vector>

#include "tessera/geometry.h"

namespace tessera { inline namespace abi_0_1 {

/// A matrix of `rows` x `columns` entries, initially zero.
class Matrix {
 public:
  Matrix(int rows, int columns);
  static Matrix identity(int size);

  int rows() const { return rows_; }
  int columns() const { return columns_; }
  long double& operator()(int i, int j) { return entries_[static_cast<std::size_t>(i * columns_ + j)]; }
  long double operator()(int i, int j) const { return entries_[static_cast<std::size_t>(i * columns_ + j)]; }

 private:
  int rows_, columns_;
  std::vector<long double> entries_;
};

/// Returns a b; a.columns() == b.rows().
Matrix operator*(const Matrix& a, const Matrix& b);

/// Returns the inverse of a square matrix by Gauss-Jordan elimination with row pivoting (Golub and Van Loan, Matrix
/// Computations, 4th ed., sec. 3.4), after scaling the columns. Returns nothing for a matrix that is singular to the
/// rounding of entries in double: a pivot is at most rows * 2^-52 of its scaled column.
std::optional<Matrix> inverse(const Matrix& matrix);

/// Returns a G b^T for a net G of a.columns() x b.columns() points [i][j], rounded once, at the end.
std::vector<Vec3> tensor_product(const Matrix& a, std::span<const Vec3> net, const Matrix& b);

}}  // namespace tessera::abi_0_1
