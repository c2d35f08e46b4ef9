#include "convert/basis/bernstein_matrices.h"

#include "basis/bernstein.h"

namespace tessera { inline namespace abi_0_1 {

// V'_i = sum_j C(m,j) C(n-m,i-j) / C(n,i) V_j is the repeated step V'_i = i/(m+1) V_{i-1} + (1 - i/(m+1)) V_i (Farin,
// Curves and Surfaces for CAGD, 5th ed., sec. 6.1). Numerators and denominators are whole numbers.
Matrix elevation_matrix(int m, int n) {
  Matrix matrix(n + 1, m + 1);
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= m; ++j)
      matrix(i, j) = static_cast<long double>(binomial(m, j) * binomial(n - m, i - j)) / binomial(n, i);
  return matrix;
}

// Point i of the piece is the blossom with n-i arguments a and i arguments b (Farin, ch. 4). Its coefficient of V_j is
// the coefficient of x^j in (1-a + a x)^(n-i) (1-b + b x)^i.
Matrix restriction_matrix(int n, double a, double b) {
  Matrix matrix(n + 1, n + 1);
  for (int i = 0; i <= n; ++i) {
    matrix(i, 0) = 1;
    for (int k = 0; k < n; ++k) {
      const long double t = k < n - i ? a : b, s = 1 - t;
      for (int j = k + 1; j > 0; --j) matrix(i, j) = s * matrix(i, j) + t * matrix(i, j - 1);
      matrix(i, 0) *= s;
    }
  }
  return matrix;
}

Matrix evaluation_matrix(int n, double t) {
  Matrix matrix(1, n + 1);
  bernstein_values<long double>(n, t, &matrix(0, 0));
  return matrix;
}

}}  // namespace tessera::abi_0_1
