#pragma once
// Borders that differ by less than a tolerance are made one: which vertices take the place of which others.

#include <cstdint>
#include <span>
#include <vector>

#include "base/function_ref.h"
#include "tess/patch_triangles.h"
#include "tess/shared_edges.h"

namespace tessera {

/// Borders and corners go by 4 * patch + side; a corner is the one at which its side starts in the ring of borders.
/// What is copied from is never copied to.
struct Weld {
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
  /// Borders that become a point, all of it a corner's.
  std::vector<Corner> poles;
  /// Of each patch, with what has become a point.
  std::vector<PatchShape> shapes;
  /// How far the vertices of each patch lie from its surface at most, rounding included; 0 where none is moved.
  std::vector<double> displacements;
};

/// Edges that one border has, all in all, are searched for the nearest edge whose distance_bound() is within the tolerance,
/// at the same parameters in either direction; edges joined so become one number in `edges`, whose borders take the points
/// of the first. Borders whose control points lie in a box no larger than the tolerance become points, with all borders
/// joined to them, and drop out of `edges`. Corners that meet at any of these edges become one.
///
/// The set must have float Bernstein blocks; `shapes`, and `roundings` of vertices, are of its patches. The tolerance is
/// finite and above 0.
Weld weld_borders(const PatchSet::Impl& set, std::span<const PatchShape> shapes, std::span<const double> roundings,
                  double tolerance, SharedEdges& edges);

/// How far the vertices of the patches that are `wanted` are moved at most, and rounded: into their places of
/// `displacements`, 0 where none is moved. As the set is now. Allocates nothing.
void measure_displacements(const PatchSet::Impl& set, const Weld& weld, std::span<const double> roundings,
                           FunctionRef<bool(std::size_t patch)> wanted, std::span<double> displacements);

}  // namespace tessera
