#pragma once
// The vertices of all faces at the stations of edges, once patches are divided.

#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include "tess/closing/edge_segments.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// The stations of all edges, with the vertices there.
struct StationVertices {
  struct Station {
    std::uint32_t edge = 0;
    std::uint32_t vertex = no_id;        ///< where the edge ends: below PatchEdges::vertex_count
    std::uint32_t first = 0, count = 0;  ///< of its vertices
    double s = 0;                        ///< the edge's parameter
  };
  std::vector<Station> stations;      ///< by edges and growing parameters
  std::vector<PatchVertex> vertices;  ///< of one station after the other
  std::vector<std::uint32_t> uses;    ///< if asked for, by vertex: see EdgeRun
  /// By edge: how many segments of boundaries lie on it that no other patch has triangles on without this.
  std::vector<std::uint32_t> own;
  /// The segments of all edges: each from one station to another.
  struct Span {
    std::uint32_t low, high;  ///< into `stations`
    bool is_alone;            ///< whether a single triangle has it, without this
  };
  std::vector<Span> spans;
  std::vector<EdgeSegment> gaps;  ///< lines that close gaps between curves, if no other patch has triangles on them
};

/// Lists the stations of all edges. Where an edge has several coedges, each gets vertices at the parameters of all:
/// missing ones are inserted. Parameters within `same_share` of the edge's range count as one.
///
/// - `is_joined`: by 4 * patch + side, whether triangles of another patch have the same border anyway.
/// - `with_uses`: whether StationVertices::uses are listed.
/// - `cancel`: looked at for each edge, unless null.
///
/// Errors: cancelled.
Result<StationVertices> station_vertices(const EdgeRuns& runs, EdgeSegments& segments, double same_share,
                                         std::span<const std::uint8_t> is_joined, bool with_uses,
                                         const std::atomic<bool>* cancel);

}}  // namespace tessera::abi_0_1
