#pragma once
// Closes the mesh of a shape along its edges: all faces get the same vertices there.
//
// A station is a parameter of an edge at which every face along the edge has a vertex. In this room:
// 1. EdgeRuns list, edge by edge, the parts of loops that run along it within one patch.
// 2. EdgeStations are found before patches are cut, so that chords and sides end at them.
// 3. station_vertices() lists the vertices that the divided patches have at stations, and inserts those that they lack.
// 4. StationPlaces are stations with a common vertex.
// 5. close_edges() gives all vertices of a place one position.
//
// Proof that the mesh is closed: along an edge, the boundaries of all its faces have vertices at the same stations, and
// those of one station get one position. So each segment belongs to as many triangles as the edge has coedges, whatever
// the positions are, if loops cover the range of the edge and the patches there have triangles. Triangles two of whose
// corners are one position drop out together with their sides, in pairs.

#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "base/function_ref.h"
#include "tess/bounds/chord_bound.h"
#include "tess/closing/patch_edit.h"
#include "tessera/tessellation.h"

namespace tessera { inline namespace abi_0_1 {

/// The vertices that faces share along edges.
struct ClosedEdges {
  /// A vertex of a patch.
  struct Member {
    std::uint32_t patch, vertex;
  };
  /// Vertices grouped by place. All vertices of a place get one position: the centre of the box of their own, or a
  /// vertex of the shape in it.
  std::vector<Member> members;
  std::vector<std::uint32_t> first_members;  ///< by place, and their number at the end
  std::vector<Vec3> places;                  ///< positions relative to the set's origin
  std::vector<PatchEdit> edits;              ///< of whole patches, by growing patch
  std::vector<float> gaps;                   ///< by edge, rounded up: see Tessellation::edge_gaps()
  double gap = 0;                            ///< the largest
  /// Cut patches whose triangles are divided, by growing place among the cuts: their bounds no longer hold.
  std::vector<std::uint32_t> edited_cuts;
  /// If asked for: the vertices along edges, by edges, then uses, then parameters. Each `vertex` is one of its patch.
  std::unique_ptr<std::vector<EdgeVertex>> edge_vertices;
  /// How many boundary edges of the mesh closing has removed.
  std::int64_t closed_segments = 0;
};

/// The faces of a set once their patches are divided. All must outlive the call that takes it.
struct DividedFaces {
  const PatchSet::Impl& set;
  const EdgeRuns& runs;
  std::span<const Division> divisions;  ///< by patch
  std::span<CutPatch> cuts;
  const EdgeStations* stations;             ///< those that `cuts` were made by; null if there are none
  std::span<const std::uint8_t> is_joined;  ///< by 4 * patch + side: triangles of another patch have the border anyway
  FunctionRef<ChordBound(std::uint32_t patch)> chord;
  double max_gap;                   ///< edges with larger gaps stay open
  bool lists_vertices;              ///< whether ClosedEdges::edge_vertices are listed
  double same_share;                ///< parameters within this share of an edge's range count as one
  const std::atomic<bool>* cancel;  ///< looked at for each edge and each patch, unless null
};

/// Finds the vertices of all edges, and inserts those that patches lack: into the cut patches, and as edits into
/// others. Distances of cut patches are extended to their new triangles. If cancelled, cut patches may be divided in
/// part. Errors: cancelled.
Result<ClosedEdges> close_edges(const DividedFaces& faces);

}}  // namespace tessera::abi_0_1
