#pragma once
// Matrices that turn the Bezier points of a curve into those of the same curve in another form, or into a point of it.
// Entries are not negative and each row sums to one, so every result stays in the hull.

#include "basis/small_matrix.h"

namespace tessera { inline namespace abi_0_1 {

/// Raises degree m to degree n >= m.
Matrix elevation_matrix(int m, int n);
/// Restricts to the piece over [a,b], 0 <= a <= b <= 1; exactly the identity for [0,1].
Matrix restriction_matrix(int n, double a, double b);
/// Evaluates at t: one row, B_{j,n}(t).
Matrix evaluation_matrix(int n, double t);

}}  // namespace tessera::abi_0_1
