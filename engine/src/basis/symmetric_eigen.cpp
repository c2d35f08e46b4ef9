#include "basis/symmetric_eigen.h"

#include <cmath>
#include <cstddef>

namespace tessera { inline namespace abi_0_1 {
namespace {

using Matrix3 = std::array<std::array<double, 3>, 3>;

/// Rotates rows and columns p and q so that a[p][q] vanishes, and the columns p and q of v.
void rotate(Matrix3& a, Matrix3& v, std::size_t p, std::size_t q) {
  if (a[p][q] == 0) return;
  const double theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
  const double t = std::copysign(1.0, theta) / (std::abs(theta) + std::hypot(theta, 1.0));
  const double c = 1 / std::hypot(t, 1.0), s = t * c;
  const double shift = t * a[p][q];
  a[p][p] -= shift;
  a[q][q] += shift;
  a[p][q] = a[q][p] = 0;
  const std::size_t r = 3 - p - q;
  const double rp = a[r][p], rq = a[r][q];
  a[r][p] = a[p][r] = c * rp - s * rq;
  a[r][q] = a[q][r] = s * rp + c * rq;
  for (auto& row : v) {
    const double vp = row[p], vq = row[q];
    row[p] = c * vp - s * vq;
    row[q] = s * vp + c * vq;
  }
}

}  // namespace

SymmetricEigen symmetric_eigen(double xx, double yy, double zz, double xy, double yz, double xz) {
  Matrix3 a{{{xx, xy, xz}, {xy, yy, yz}, {xz, yz, zz}}};
  Matrix3 v{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  // Convergence is quadratic: six sweeps suffice for any matrix. Further sweeps skip zero entries.
  for (int sweep = 0; sweep < 16; ++sweep) {
    rotate(a, v, 0, 1);
    rotate(a, v, 0, 2);
    rotate(a, v, 1, 2);
  }
  SymmetricEigen result{{a[0][0], a[1][1], a[2][2]}, {}};
  for (std::size_t k = 0; k < 3; ++k) result.vectors[k] = normalized({v[0][k], v[1][k], v[2][k]});
  return result;
}

}}  // namespace tessera::abi_0_1
