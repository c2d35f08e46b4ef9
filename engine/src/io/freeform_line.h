#pragma once
// One direction of free-form geometry: whether its numbers fit each other, and its pieces.

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "io/freeform.h"
#include "tessera/tensor_patch.h"

namespace tessera::inline abi_0_1 {

/// How many control points the line wants. `available` is how many there are, which bounds the steps. Errors:
/// unsupported_degree, count_mismatch, invalid_argument.
Result<std::size_t> control_count(FreeformType type, const FreeformLine& line, char direction, std::size_t available);

/// The degree, once control_count() has passed the line.
int degree_of(FreeformType type, const FreeformLine& line);

/// Errors: invalid_argument (empty, or not within parm). For all but bspline.
Status check_within(const FreeformLine& line, char direction, double from, double to);

/// Each inner parameter as often as the degree says, those at the ends once more.
std::vector<double> bezier_knots(int degree, std::span<const double> parameters);

/// What a piece of taylor or bmatrix is blended by.
Result<BasisMatrix> piece_basis(FreeformType type, const FreeformLine& line);
/// By how many control points the pieces of taylor or bmatrix are apart.
std::size_t piece_step(FreeformType type, const FreeformLine& line);

/// Bezier point r of a line of `pieces` Catmull-Rom pieces, whose control points are at(i): the pieces' control points
/// (c1, c1 + (c2 - c0) / 6, c2 - (c3 - c1) / 6, c2), the last of one being the first of the next.
template <class At>
Homogeneous cardinal_bezier_point(std::size_t r, std::size_t pieces, At&& at) {
  const std::size_t piece = std::min(r / 3, pieces - 1), k = r - 3 * piece;
  if (k == 0) return at(piece + 1);
  if (k == 3) return at(piece + 2);
  if (k == 1) return at(piece + 1) + 1.0 / 6 * (at(piece + 2) - at(piece));
  return at(piece + 2) - 1.0 / 6 * (at(piece + 3) - at(piece + 1));
}

}  // namespace tessera::inline abi_0_1
