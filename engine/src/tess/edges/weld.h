#pragma once
// Borders that differ by less than a tolerance are made one: which vertices take the place of which others.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/function_ref.h"
#include "tess/edges/shared_edges.h"
#include "tess/write/patch_triangles.h"

namespace tessera::inline abi_0_1 {

/// Vertices of the rings of borders that take what others have. Borders and corners go by 4 * patch + side; a corner is the
/// one at which its side starts in the ring. What is copied from is never copied to.
struct VertexCopies {
  /// The points inside a border become those of another one.
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
  /// Borders all of which is a point, a corner's.
  std::vector<Corner> poles;
  friend bool operator==(const VertexCopies&, const VertexCopies&) = default;
};

/// Positions that are taken from others.
struct Weld : VertexCopies {
  /// Borders that are joined by their distance and not by their bits, and those made points.
  std::size_t joined_by_distance = 0;
  /// Of each patch, with what has become a point.
  std::vector<PatchShape> shapes;
  /// How far the vertices of each patch lie from its surface at most, rounding included; 0 where none is moved.
  std::vector<double> displacements;
};

/// The corners at the ends of a border, in the direction of the parameter along it.
std::array<std::uint32_t, 2> ends_of(std::uint32_t border);
/// Where a corner's control point lies.
Vec3 corner_of(const BezierPatch& patch, std::uint32_t corner);

/// Edges that one border has, all in all, are searched for the nearest edge whose distance_bound() is within the tolerance,
/// at the same parameters in either direction; edges joined so become one number in `edges`, whose borders take the points
/// of the first. Borders whose control points lie in a box no larger than the tolerance become points, with all borders
/// joined to them, and drop out of `edges`. Corners that meet at any of these edges become one.
///
/// `every_edge`: all borders of an edge take the points of its first one, and all corners that meet there those of one,
/// though their packed control points are the same bits: where vertices are made of doubles, these may differ.
///
/// The set must have float Bernstein blocks; `shapes`, and `roundings` of vertices, are of its patches. The tolerance is
/// finite and at least 0, and above 0 unless `every_edge`.
Weld weld_borders(const PatchSet::Impl& set, std::span<const PatchShape> shapes, std::span<const double> roundings,
                  double tolerance, SharedEdges& edges, bool every_edge = false);

/// How far the vertices of the patches that are `wanted` are moved at most, and rounded: raises `displacements` to it. As
/// the set is now. `same_bits_stay`: nothing is moved by a copy from a border of the same bits. Allocates nothing.
void measure_displacements(const PatchSet::Impl& set, const VertexCopies& copies, std::span<const double> roundings,
                           FunctionRef<bool(std::size_t patch)> wanted, std::span<double> displacements,
                           bool same_bits_stay = false);

}  // namespace tessera::inline abi_0_1
