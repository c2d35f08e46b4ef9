#pragma once
// Joins borders that differ by less than a tolerance: lists the vertices that take the place of others.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/function_ref.h"
#include "tess/cells/patch_triangles.h"
#include "tess/edges/shared_edges.h"

namespace tessera { inline namespace abi_0_1 {

/// Vertices of the rings of borders that are copies of others. Borders and corners are numbered 4 * patch + side; a
/// corner is the one at which its side starts in the ring. No vertex is both copied from and copied to.
struct VertexCopies {
  /// The points inside border `to` become those of border `from`.
  struct Border {
    std::uint32_t to, from;
    bool reversed;  ///< their parameters run in opposite directions
    friend bool operator==(const Border&, const Border&) = default;
  };
  struct Corner {
    std::uint32_t to, from;
    friend bool operator==(const Corner&, const Corner&) = default;
  };
  std::vector<Border> borders;
  std::vector<Corner> corners;
  /// Borders `to` that are entirely one point, that of corner `from`.
  std::vector<Corner> poles;
  friend bool operator==(const VertexCopies&, const VertexCopies&) = default;
};

/// Copies of positions that welding makes.
struct Weld : VertexCopies {
  /// The number of borders joined by their distance and not by their bits, and of those made points.
  std::size_t joined_by_distance = 0;
  /// `[patch]`: its shape, in which borders made points are collapsed; empty if nothing is welded.
  std::vector<PatchShape> shapes;
  /// `[patch]`: how far its vertices lie from its surface at most, including rounding; 0 where none is moved; empty if
  /// nothing is welded.
  std::vector<double> displacements;
};

/// The borders that are welded.
///
/// Borders whose control points lie in a box no larger than `reach` become points, with all borders joined to them; if
/// is_relative, only if the box is also no larger than point_share of that of their patch.
struct WeldRules {
  static constexpr double point_share = 0x1p-18;  ///< above the rounding of numbers of six digits
  double reach = 0;  ///< the largest distance of borders that are joined; finite, at least 0
  /// Whether borders must also be eight times as long as they are apart, and only edges with a single border are
  /// joined: strips thinner than the reach stay between their neighbours.
  bool is_relative = false;
  /// `[patch]`: 1 if its vertices come from double control points; empty if no patch's do. These give their points to
  /// all other borders of their edges, and to all other corners that meet there: the packed control points are the same
  /// bits, but such vertices may differ.
  std::span<const std::uint8_t> f64_patches = {};
  /// `[4 * patch + side]`: 1 for borders that are joined by their bits alone; empty if for none.
  std::span<const std::uint8_t> stay = {};
  /// ChordBlocks::short_sides() for this reach: no other patches have borders that become points. May be empty if the
  /// reach is 0.
  std::span<const std::uint16_t> short_sides = {};
  /// `[edge]`: its border if there is only one, counting those of curves, or none. Empty if that is not known.
  std::span<const std::uint32_t> only_borders = {};
};

/// Welds borders.
///
/// - Each edge with a single border is joined to the nearest edge whose distance_bound(), at the same parameters in
///   either direction, is within reach. Opposite borders of a patch are not joined if it is thinner than the reach.
///   Joined edges get one number in `edges`, and their borders take the points of that which comes_before() all others.
/// - Borders made points are removed from `edges`.
/// - Corners that meet at any of these edges become one, that with the least coordinates.
/// - Borders and corners whose vertices come from doubles come before all others, so that these are moved to them.
///
/// The choice of borders to join, and of the one that moves, depends on their control points and on WeldRules alone:
/// not on others that are farther away, nor on the order of patches. The set must have float Bernstein blocks. `shapes`
/// and `roundings` (of vertices) are those of its patches. Returns nothing to copy, and no shapes, if nothing is
/// welded.
Weld weld_borders(const PatchSet::Impl& set, std::span<const PatchShape> shapes, std::span<const double> roundings,
                  const WeldRules& rules, SharedEdges& edges);

/// Raises `displacements` of the `wanted` patches to how far their vertices are moved at most, including rounding, in
/// the set as it is now. A copy between the same control points in double moves nothing: its rounding is no more than
/// the patch's own. `same_bits_stay`: nor does a copy from a border of the same packed bits. Allocates nothing.
void measure_displacements(const PatchSet::Impl& set, const VertexCopies& copies, std::span<const double> roundings,
                           FunctionRef<bool(std::size_t patch)> wanted, std::span<double> displacements,
                           bool same_bits_stay = false);

}}  // namespace tessera::abi_0_1
