#pragma once
// The vertices of all faces at the stations of edges, once patches are divided.

#include <array>
#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include "tess/closing/edge_segments.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// A station of an edge, with the vertices there.
struct Station {
  double s = 0;                  ///< the edge's parameter
  std::uint32_t vertex = no_id;  ///< where the edge ends: below PatchEdges::vertex_count
  std::uint32_t first = 0;       ///< its first vertex, in StationBlock::vertices
  bool is_odd = false;           ///< whether an odd number of segments reaches from it to the next station of its edge
};

/// The stations of edges that follow each other, in the order of edges and growing parameters.
struct StationBlock {
  struct Edge {
    std::uint32_t edge = 0;
    std::uint32_t first = 0;  ///< its first station, in `stations`
    std::uint32_t own = 0;    ///< how many segments of boundaries lie on it that no other patch has triangles on
    std::uint32_t alone = 0;  ///< how many segments single triangles have
  };
  /// A segment of a line that closes a gap between curves. No other patch has triangles on it.
  struct Gap {
    SegmentEnd low, high;
    bool begins = false;  ///< see SegmentList::begins()
  };
  std::vector<Edge> edges;            ///< those with segments; after them one that begins where all stations end
  std::vector<Station> stations;      ///< after them one that begins where all vertices end
  std::vector<PatchVertex> vertices;  ///< of one station after the other
  std::vector<std::uint32_t> uses;    ///< by vertex, if they are asked for: see EdgeRun
  std::vector<std::array<PatchVertex, 2>> same;  ///< see EdgeSegments::same()
  std::vector<Gap> gaps;                         ///< all of them are in the last block
  std::uint32_t first_station = 0;               ///< how many stations the blocks before have

  std::span<const Edge> all_edges() const { return std::span(edges).first(edges.size() - 1); }
  std::uint32_t station_count() const { return static_cast<std::uint32_t>(stations.size() - 1); }
};

/// The stations of all edges.
struct StationVertices {
  std::vector<StationBlock> blocks;      ///< the same for any number of threads
  std::vector<InsertedVertex> inserted;  ///< in the order of edges; those of no station are not needed
  std::uint32_t station_count = 0;
};

/// The faces and rules by which stations are listed. All must outlive the call that takes it.
struct StationRequest {
  const PatchSet::Impl& set;
  const EdgeRuns& runs;
  std::span<const Division> divisions;  ///< by patch
  std::span<const CutPatch> cuts;
  const EdgeStations* stations;             ///< those that `cuts` were made by; null if there are none
  std::span<const std::uint8_t> is_joined;  ///< by 4 * patch + side: another patch's triangles have the border anyway
  double same_share;                        ///< parameters within this share of an edge's range count as one
  bool with_uses;                           ///< whether StationBlock::uses are listed
  const std::atomic<bool>* cancel;          ///< looked at for each edge, unless null
};

/// Lists the stations of all edges. Where an edge has several coedges, each gets vertices at the parameters of all:
/// missing ones are inserted. Edges are shared among the threads of the caller's arena. Errors: cancelled.
Result<StationVertices> station_vertices(const StationRequest& of);

}}  // namespace tessera::abi_0_1
