#include "basis/small_matrix.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Divides each column by its largest entry and returns these entries; nothing if a column is zero or not finite.
std::optional<std::vector<long double>> scale_columns(Matrix& matrix) {
  std::vector<long double> scales;
  for (int j = 0; j < matrix.columns(); ++j) {
    long double largest = 0;
    for (int i = 0; i < matrix.rows(); ++i) largest = std::max(largest, std::abs(matrix(i, j)));
    if (!(largest > 0) || !std::isfinite(largest)) return std::nullopt;
    for (int i = 0; i < matrix.rows(); ++i) matrix(i, j) /= largest;
    scales.push_back(largest);
  }
  return scales;
}

void swap_rows(Matrix& matrix, int a, int b) {
  for (int j = 0; j < matrix.columns(); ++j) std::swap(matrix(a, j), matrix(b, j));
}

void add_row(Matrix& matrix, int a, long double factor, int b) {
  for (int j = 0; j < matrix.columns(); ++j) matrix(a, j) += factor * matrix(b, j);
}

}  // namespace

Matrix::Matrix(int rows, int columns)
    : rows_(rows), columns_(columns), entries_(static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns)) {}

Matrix Matrix::identity(int size) {
  Matrix result(size, size);
  for (int i = 0; i < size; ++i) result(i, i) = 1;
  return result;
}

Matrix operator*(const Matrix& a, const Matrix& b) {
  assert(a.columns() == b.rows());
  Matrix product(a.rows(), b.columns());
  for (int i = 0; i < a.rows(); ++i)
    for (int j = 0; j < b.columns(); ++j)
      for (int k = 0; k < a.columns(); ++k) product(i, j) += a(i, k) * b(k, j);
  return product;
}

std::optional<Matrix> inverse(const Matrix& matrix) {
  assert(matrix.rows() == matrix.columns());
  const int size = matrix.rows();
  Matrix left = matrix, right = Matrix::identity(size);
  const auto scales = scale_columns(left);
  if (!scales) return std::nullopt;
  for (int k = 0; k < size; ++k) {
    int pivot = k;
    for (int i = k + 1; i < size; ++i)
      if (std::abs(left(i, k)) > std::abs(left(pivot, k))) pivot = i;
    if (!(std::abs(left(pivot, k)) > size * 0x1p-52L)) return std::nullopt;
    swap_rows(left, k, pivot);
    swap_rows(right, k, pivot);
    for (int i = 0; i < size; ++i) {
      if (i == k) continue;
      const long double factor = -left(i, k) / left(k, k);
      add_row(left, i, factor, k);
      add_row(right, i, factor, k);
    }
  }
  for (int i = 0; i < size; ++i)
    for (int j = 0; j < size; ++j) right(i, j) /= left(i, i) * (*scales)[static_cast<std::size_t>(i)];
  return right;
}

std::vector<Vec3> tensor_product(const Matrix& a, std::span<const Vec3> net, const Matrix& b) {
  const int m = a.columns(), n = b.columns();
  assert(net.size() == static_cast<std::size_t>(m) * static_cast<std::size_t>(n));
  std::vector<Vec3> result(static_cast<std::size_t>(a.rows() * b.rows()));
  for (double Vec3::*component : {&Vec3::x, &Vec3::y, &Vec3::z}) {
    Matrix across(m, b.rows());  // G b^T
    for (int i = 0; i < m; ++i)
      for (int j = 0; j < b.rows(); ++j)
        for (int l = 0; l < n; ++l) across(i, j) += b(j, l) * net[static_cast<std::size_t>(i * n + l)].*component;
    const Matrix product = a * across;
    for (int i = 0; i < a.rows(); ++i)
      for (int j = 0; j < b.rows(); ++j)
        result[static_cast<std::size_t>(i * b.rows() + j)].*component = static_cast<double>(product(i, j));
  }
  return result;
}

}}  // namespace tessera::abi_0_1
