#pragma once
// Pieces of curves that become one edge, and ends of curves that become one vertex.

#include <cstdint>
#include <span>
#include <vector>

#include "base/union_find.h"
#include "join/curve_pieces.h"

namespace tessera { inline namespace abi_0_1 {

/// A piece of a group.
struct GroupMember {
  std::uint32_t piece;
  bool turned;  ///< whether it runs against the first member
};

/// Pieces that become one edge. The first leads: the edge has its parameter.
using PieceGroup = std::vector<GroupMember>;

/// Groups pieces, and unites the vertices at their ends.
///
/// - Nearest pairs first. Two pieces that have no other yet become a group whatever their distance within reach.
///   Further ones join them only within an eighth of the distance: an edge of three faces is one if they meet as well
///   as that. Otherwise the two nearest are an edge, and the third stays free.
/// - Then pieces within the distance from end to end, whose ends have become the same two vertices, are a group.
/// - The leader is the first by CurvePiece::rank.
///
/// Result: groups of two pieces and more; `vertices` has an element per vertex.
std::vector<PieceGroup> group_pieces(const FreeCurves& free, std::span<const CurvePiece> pieces,
                                     std::vector<PiecePair> pairs, UnionFind& vertices);

}}  // namespace tessera::abi_0_1
