#include "measure/centred_power.h"

#include <cmath>

#include "basis/bernstein.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// B_{i,n}((1 + x) / 2) = C(n,i) 2^-n (1 + x)^i (1 - x)^(n - i).
PowerMatrix make_matrix(int n) {
  PowerMatrix matrix{};
  for (int k = 0; k <= n; ++k)
    for (int i = 0; i <= n; ++i) {
      double sum = 0;
      for (int a = 0; a <= k; ++a) sum += ((k - a) % 2 != 0 ? -1 : 1) * binomial(i, a) * binomial(n - i, k - a);
      matrix[static_cast<std::size_t>(k)][static_cast<std::size_t>(i)] = std::ldexp(binomial(n, i) * sum, -n);
    }
  return matrix;
}

std::array<PowerMatrix, max_order> make_matrices() {
  std::array<PowerMatrix, max_order> all;
  for (int n = 0; n <= max_degree; ++n) all[static_cast<std::size_t>(n)] = make_matrix(n);
  return all;
}

}  // namespace

const PowerMatrix& centred_power(int degree) {
  static const std::array<PowerMatrix, max_order> matrices = make_matrices();
  return matrices[static_cast<std::size_t>(degree)];
}

}}  // namespace tessera::abi_0_1
