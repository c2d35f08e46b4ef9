#pragma once
// A monotone piece of a trimming loop, the unit that regions and meshes of trimmed faces work with.

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "tessera/curve.h"
#include "trim/plane_bezier.h"

namespace tessera { inline namespace abi_0_1 {

/// A Bezier curve whose control polygon is monotone in u and in v, hence so is the curve (variation diminution). It
/// crosses no line between patches, but may end on one or run along one. Its ends are the same bits as those of its
/// neighbours in the loop; an end on a line between patches has that line's own number.
struct TrimPiece {
  PlaneBezier curve;
  /// A straight piece without error lies on the line through these two points, which are those of the caller: cutting
  /// rounds the piece's own ends. Otherwise they are not used.
  ParameterPoint line_from = {}, line_to = {};
  bool exact_line = false;
  ParameterPoint error = {};          ///< the largest distance from the caller's curve in u, and in v
  std::uint32_t loop = no_id;         ///< index into the loops; none for the sides of the domain
  std::uint32_t curve_index = no_id;  ///< index into TrimLoop::curves; none for lines that close a gap
  Interval range = {};                ///< the parameters of the caller's curve

  const ParameterPoint& start() const { return curve.points.front(); }
  const ParameterPoint& end() const { return curve.points.back(); }
  double lower_u() const { return std::min(start().u, end().u); }
  double upper_u() const { return std::max(start().u, end().u); }
  double lower_v() const { return std::min(start().v, end().v); }
  double upper_v() const { return std::max(start().v, end().v); }
};

/// Makes the exact line from one point to another.
inline TrimPiece line_piece(const ParameterPoint& from, const ParameterPoint& to, std::uint32_t loop) {
  TrimPiece piece{.curve = {{from, to}}, .line_from = from, .line_to = to, .exact_line = true};
  piece.loop = loop;
  return piece;
}

}}  // namespace tessera::abi_0_1
