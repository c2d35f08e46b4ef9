#pragma once
// Vertices and edges that faces share, and how loops use them.
//
// Ids are indices into the arrays of one Shape (see model.h), so a shape may be copied, placed and moved to another
// model as it is.

#include <cstdint>
#include <optional>
#include <vector>

#include "tessera/colour.h"
#include "tessera/curve.h"
#include "tessera/geometry.h"

#pragma GCC visibility push(default)
namespace tessera { inline namespace abi_0_1 {

/// How one curve of a loop uses an edge. A seam has two coedges in one face, each with its own curve.
struct Coedge {
  std::uint32_t edge = no_id;  ///< index into Shape::edges
  bool reversed = false;       ///< whether the loop's curve runs from the edge's end to its start
  /// Maps the edge's parameter s to the parameter t of the loop's curve: t is x of this curve at s. It is monotone, of
  /// degree 1 (rational: the parameters of two arcs are related by a fraction of linear functions). Empty: t = s, or
  /// t = from + to - s where reversed, with the ends of the curve's domain.
  std::optional<Curve> parameter = {};
  friend bool operator==(const Coedge&, const Coedge&) = default;  ///< by all members
};

/// A point where edges end.
struct BrepVertex {
  Vec3 position;         ///< in the shape's space
  double tolerance = 0;  ///< as the file states it; no bound
};

/// A curve where faces meet.
struct BrepEdge {
  std::uint32_t start = no_id, end = no_id;  ///< vertices; no_id: none is stated; equal: the edge is closed
  Interval range = {};                       ///< the parameter s, from start to end
  std::optional<Curve> curve = {};           ///< its points in the shape's space by s; empty: none is stated
  double tolerance = 0;                      ///< as the file states it; no bound
  bool degenerate = false;                   ///< a point, such as the pole of a sphere; it has no curve
  bool same_parameter = false;               ///< the file states that the faces' curves are within tolerance at equal s
};

/// Faces that are joined by their edges.
struct Shell {
  std::vector<std::uint32_t> faces;  ///< indices into Shape::faces
  std::uint32_t solid = no_id;       ///< below Shape::solid_count: it is the solid's skin, or bounds a cavity of it
};

}}  // namespace tessera::abi_0_1
#pragma GCC visibility pop
