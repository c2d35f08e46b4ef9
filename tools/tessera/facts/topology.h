#pragma once
// The shapes of a model: solids, shells, edges, and how far faces are apart along them.

#include <cstddef>
#include <optional>
#include <string>

#include "console/report.h"
#include "tessera/model.h"
#include "tessera/status.h"

namespace tessera::cli {

/// Counts over all instances.
struct TopologyFacts {
  std::size_t shapes = 0, instances = 0, solids = 0, closed_shells = 0, open_shells = 0, vertices = 0;
  std::size_t edges = 0;                    ///< save points, such as poles
  std::size_t one = 0, two = 0, more = 0;   ///< edges by their number of coedges; a seam has two
  std::size_t points = 0;                   ///< degenerate edges
  double gap = 0;                           ///< the largest distance of two faces along an edge, in the shape's space
  std::size_t gap_shape = 0, gap_edge = 0;  ///< where it is
};
inline constexpr int gap_samples = 65;  ///< of each edge

/// Counts. Errors: those of edge_gaps().
Result<TopologyFacts> count_topology(const Model& model);

/// The facts of a model once joined_edges() has joined its edges.
struct JoinedFacts {
  TopologyFacts topology;
  double distance = 0;  ///< within which they are joined, the largest of all shapes
};

/// Joins edges as joined_if_free() and counts. Empty where nothing is to be joined. Errors: those of joined_edges().
Result<std::optional<JoinedFacts>> count_joined(const Model& model);

/// Adds the facts of `info`; in words only if the model has shapes.
void add_topology(Report& report, const Model& model, const TopologyFacts& facts);
/// Adds a line and an object, or null without facts.
void add_joined(Report& report, const std::optional<JoinedFacts>& facts);

}  // namespace tessera::cli
