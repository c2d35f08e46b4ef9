#pragma once
// The curves of loops whose edges no other curve uses: those that are matched.

#include <cstdint>
#include <utility>
#include <vector>

#include "join/space_curve.h"
#include "tessera/topology.h"

namespace tessera { inline namespace abi_0_1 {

/// Gives each loop without coedges edges of its own, one per curve, and each face without loops an outline along the
/// sides of its domain. Curves of a loop that meet within `distance` share a vertex. Errors: those of evaluate_jet()
/// (index = the face).
Status name_all_edges(Shape& shape, double distance);

/// A place that divides a curve.
struct CurveNode {
  double t;
  Vec3 point;
  std::uint32_t vertex;  ///< index into Shape::vertices
};

/// The curve of an edge that is used once.
struct FreeCurve {
  std::uint32_t edge;
  EdgeUse use;
  SpaceCurve curve;
  double reach;                  ///< within which another point may be one of the curve's
  std::vector<CurveNode> nodes;  ///< in order of t, both ends included
};

/// All curves that are matched, in the order of edges.
struct FreeCurves {
  double distance;
  Line line;  ///< where the curves lie
  std::vector<FreeCurve> curves;
  std::vector<std::uint32_t> points;  ///< edges that are points within a small share of the distance
  std::vector<std::pair<std::uint32_t, std::uint32_t>> same_vertices;
};
/// Lists the curves of edges that are used once and are no points. Adds vertices where edges state none. The shape's
/// faces and their loops must stay as they are. Failures go to `failure`, see SpaceCurve. Errors: as above.
Result<FreeCurves> find_free_curves(Shape& shape, double distance, Line line, Status& failure);

/// The farthest that ends may lie from one another on two curves, for a reach within which the curves are.
inline constexpr double end_reach = 1.5;

}}  // namespace tessera::abi_0_1
