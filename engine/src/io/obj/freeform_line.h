#pragma once
// One direction of free-form geometry: checks that its numbers fit each other, and finds its pieces.

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "io/obj/freeform.h"
#include "tessera/tensor_patch.h"

namespace tessera { inline namespace abi_0_1 {

/// The number of control points that the direction needs. `available` is how many there are; it bounds the steps.
/// Errors: unsupported_degree, count_mismatch, invalid_argument.
Result<std::size_t> control_count(FreeformType type, const FreeformLine& line, char direction, std::size_t available);

/// The degree. Requires that control_count() has succeeded.
int degree_of(FreeformType type, const FreeformLine& line);

/// Checks the range [from, to] of every type but bspline. Errors: invalid_argument (empty, or not within parm).
Status check_within(const FreeformLine& line, char direction, double from, double to);

/// The knots: each inner parameter with multiplicity `degree`, the end ones with one more.
std::vector<double> bezier_knots(int degree, std::span<const double> parameters);

/// The basis of a piece of taylor or bmatrix.
Result<BasisMatrix> piece_basis(FreeformType type, const FreeformLine& line);
/// The step in control points between pieces of taylor or bmatrix.
std::size_t piece_step(FreeformType type, const FreeformLine& line);

/// Bezier point r of `pieces` Catmull-Rom pieces whose control points are at(i). Each piece has the Bezier points (c1,
/// c1 + (c2 - c0) / 6, c2 - (c3 - c1) / 6, c2); the last of one is the first of the next.
template <class At>
Homogeneous cardinal_bezier_point(std::size_t r, std::size_t pieces, At&& at) {
  const std::size_t piece = std::min(r / 3, pieces - 1), k = r - 3 * piece;
  if (k == 0) return at(piece + 1);
  if (k == 3) return at(piece + 2);
  if (k == 1) return at(piece + 1) + 1.0 / 6 * (at(piece + 2) - at(piece));
  return at(piece + 2) - 1.0 / 6 * (at(piece + 3) - at(piece + 1));
}

}}  // namespace tessera::abi_0_1
