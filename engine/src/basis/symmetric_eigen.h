#pragma once
// Eigenvalues and eigenvectors of symmetric 3 x 3 matrices.

#include <array>

#include "tessera/geometry.h"

namespace tessera::inline abi_0_1 {

struct SymmetricEigen {
  std::array<double, 3> values;  ///< in the order in which the axes lie nearest, no sorting
  std::array<Vec3, 3> vectors;   ///< orthonormal to rounding
};

/// By Jacobi rotations (Golub and Van Loan, Matrix Computations, 4th ed., sec. 8.5): a diagonal matrix comes back
/// untouched; errors are a few units of the largest |entry|. Entries are finite and their squares do not overflow.
SymmetricEigen symmetric_eigen(double xx, double yy, double zz, double xy, double yz, double xz);

}  // namespace tessera::inline abi_0_1
