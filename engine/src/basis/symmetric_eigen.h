#pragma once
// Eigenvalues and eigenvectors of symmetric 3 x 3 matrices.

#include <array>

#include "tessera/geometry.h"

namespace tessera { inline namespace abi_0_1 {

struct SymmetricEigen {
  std::array<double, 3> values;  ///< not sorted: each stays with the axis nearest to its vector
  std::array<Vec3, 3> vectors;   ///< orthonormal to rounding
};

/// Returns the eigenvalues and eigenvectors by Jacobi rotations (Golub and Van Loan, Matrix Computations, 4th ed., sec.
/// 8.5). A diagonal matrix is returned unchanged; errors are a few units of the largest |entry|. The entries must be
/// finite and their squares must not overflow.
SymmetricEigen symmetric_eigen(double xx, double yy, double zz, double xy, double yz, double xz);

}}  // namespace tessera::abi_0_1
