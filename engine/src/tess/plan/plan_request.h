#pragma once
// The limits that a plan keeps, and how borders are joined.

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "tess/bounds/picture.h"
#include "tess/cells/segments.h"
#include "tess/edges/weld.h"

namespace tessera { inline namespace abi_0_1 {

/// The limits to keep besides a distance, and how borders are joined.
struct PlannerOptions {
  WeldRules weld = {};
  /// `[patch]`: 1 if its vertices come from double control points; empty if no patch's do.
  std::vector<std::uint8_t> f64_patches = {};
  bool is_f64(std::size_t patch) const { return !f64_patches.empty() && f64_patches[patch]; }
  std::vector<double> shares = {};  ///< `[patch]`: the share of the distance that it keeps, at most 1; empty: all of it
  double least_share = 1;
  bool f64_positions = false;   ///< the mesh has positions in double; needs all f64_patches
  std::optional<double> angle;  ///< radians, above 0, at most pi / 2
  int angle_rate = 64;          ///< the least rate where the angle has no bound
  std::optional<Camera> camera;
  double pixels = 0;  ///< above 0 if there is a camera
  bool fewest = false;
  bool closes_edges = true;  ///< whether faces get the same vertices along the edges of shapes
  double max_gap = std::numeric_limits<double>::infinity();  ///< of edges that are closed
  bool lists_edge_vertices = false;                          ///< see ClosedEdges::edge_vertices
  bool keeps_bounds = false;  ///< keeps the bounds of angles, half a KiB per patch, for many plans of the same facts
};

/// Segments that patches keep instead of the best ones, as long as they keep the tolerances and have at most (1 +
/// spare) times the cells of the best ones.
struct KeptSegments {
  std::span<const PatchSegments> segments = {};  ///< `[patch]`, or empty
  double spare = 0;
};

/// The demands on one plan.
struct PlanRequest {
  double tolerance;     ///< the distance, infinite if there is no limit
  bool fewest = false;  ///< see TessellationOptions::fewest
  KeptSegments kept = {};
  /// A limit on the triangles of each cut patch, and for tolerances that messages propose.
  std::uint64_t max_triangles = std::numeric_limits<std::uint64_t>::max();
  double border_tolerance = 0;  ///< see TessellationOptions::border_tolerance; 0: none
  double headroom = 0;   ///< the part of what the limits leave that new segments leave for edits; kept ones may take it
  double share = 1;      ///< the part of what the limits leave that cells may take
  double slack = 1;      ///< the factor by which the limits of a patch may be exceeded
  bool uniform = false;  ///< whether segments are of one length
};

}}  // namespace tessera::abi_0_1
