#pragma once
// Pieces of curves between nodes, and which of them run side by side.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "join/free_curves.h"

namespace tessera { inline namespace abi_0_1 {

/// A curve between two consecutive nodes.
struct CurvePiece {
  std::uint32_t curve, node;   ///< index into FreeCurves::curves; from `node` to the next
  Interval range;              ///< of the curve's parameter
  std::array<Vec3, 3> points;  ///< start, middle, end
  double extent;               ///< largest distance from the start
  double reach;                ///< within which another piece may be the same edge
  /// The place in an order that geometry alone decides: pieces with few control points first, then by their points.
  std::uint32_t rank;

  const Vec3& start() const { return points[0]; }
  const Vec3& end() const { return points[2]; }
};

/// Lists the pieces of all curves, in their order.
std::vector<CurvePiece> list_pieces(const FreeCurves& free);

/// Two pieces that run side by side.
struct PiecePair {
  std::uint32_t a, b;  ///< a < b
  bool turned;         ///< whether they run in opposite directions
  double distance;     ///< the largest from a point of one to the nearest of the other, as sampled
  bool is_strip;       ///< whether their face lies between them, so that it would vanish if they were one edge
};

/// Lists all pairs of pieces within reach. Of pieces with very many neighbours the nearest 16 pairs by their ends are
/// looked at. Time: O(n log n) for n pieces with few neighbours.
std::vector<PiecePair> list_pairs(const FreeCurves& free, std::span<const CurvePiece> pieces);

}}  // namespace tessera::abi_0_1
