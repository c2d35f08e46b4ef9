#pragma once
// Tells which borders of an edge run in opposite directions, after welding too.

#include <cstdint>
#include <span>
#include <vector>

#include "tess/edges/shared_edges.h"
#include "tess/edges/weld.h"

namespace tessera { inline namespace abi_0_1 {

/// The directions of all borders along their edges, as they were when the edges were found: needs the set at that
/// revision. Borders are numbered 4 * patch + side.
///
/// The leading border of an edge gives its direction: the first border that takes no vertices from another, of the
/// whole patches if there are any, else of the others. Two borders of one edge are the same bits, or welding lists one
/// of them with its direction; a border that loops cut is the same bits as the leading one, or as a welded one.
class EdgeDirections {
 public:
  /// `whole`: the shapes by which whole patches are divided; others count as curves. `all`: the shapes of all patches.
  EdgeDirections(const PatchSet::Impl& set, const SharedEdges& edges, const VertexCopies& weld,
                 std::span<const PatchShape> whole, std::span<const PatchShape> all);

  /// Returns the leading border of an edge; none if only curves have it.
  std::uint32_t leading(std::uint32_t edge) const { return leading_[edge]; }
  bool is_welded(std::uint32_t border) const { return weld_at_[border] != no_id; }
  /// Whether a border runs against the leading one of its edge. False for borders of no edge.
  bool runs_against_leading(std::uint32_t border) const;
  /// Whether the borders that are not welded are still the same bits as the leading ones of their edges, in the set as
  /// it is now.
  bool hold() const;

 private:
  std::uint32_t edge(std::uint32_t border) const { return edges_.edge(border / 4, all_sides[border % 4]); }
  bool is_same(std::uint32_t border, std::uint32_t other) const;

  const PatchSet::Impl& set_;
  const SharedEdges& edges_;
  const VertexCopies& weld_;
  std::vector<std::uint32_t> weld_at_;       ///< `[border]`: its place among the welded borders, or none
  std::vector<std::uint32_t> leading_;       ///< `[edge]`
  std::vector<std::uint32_t> first_welded_;  ///< `[edge]`: a place among the welded borders, or none
  std::vector<std::uint32_t> next_welded_;   ///< `[place among the welded borders]`: another of that edge, or none
};

}}  // namespace tessera::abi_0_1
