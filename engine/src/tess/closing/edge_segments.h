#pragma once
// The parts of a shape's edges that patches have on their boundaries: segments between vertices that follow each other.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "tess/cells/stitched_patch.h"
#include "tess/closing/edge_runs.h"
#include "tess/closing/edge_stations.h"
#include "tess/closing/side_vertices.h"
#include "tess/trimmed/cut_patch.h"

namespace tessera { inline namespace abi_0_1 {

/// A vertex that a patch needs inside a segment of its boundary.
struct InsertedVertex {
  std::uint32_t patch = 0;
  std::uint32_t start = 0, end = 0;  ///< the vertices of the segment as it was
  double at = 0;                     ///< grows from start to end
  ParameterPoint local;              ///< in the patch's own parameters
  bool widens_sliver = false;        ///< it is on a chord whose curve may lie on both sides of the parts
};

/// A vertex of a patch: one that it has, or an index into the inserted ones.
struct PatchVertex {
  static constexpr std::uint32_t inserted = 0x80000000;  ///< a bit of `vertex`: the rest is an index into the list
  std::uint32_t patch = 0, vertex = 0;
  friend bool operator==(const PatchVertex&, const PatchVertex&) = default;
};

/// A part of a run, between vertices of a patch's boundary that follow each other. Its ends have growing parameters of
/// the edge.
struct EdgeSegment {
  const EdgeRun* run = nullptr;
  double from = 0, to = 0;           ///< the edge's parameter at its ends
  PatchVertex low, high;             ///< at `from` and at `to`
  std::uint32_t start = 0, end = 0;  ///< the boundary's own vertices; equal: a point, which gets no more vertices
  bool has_triangle = true;          ///< see CutPatch::LoopSegment
  /// Whether an end is the boundary's own vertex, so that each segment of a boundary counts once.
  bool begins() const { return low.vertex == start || high.vertex == start; }
};

/// The segments of all edges of a set, and the vertices that they need at the ends of edges.
class EdgeSegments {
 public:
  /// Prepares for finding them. `divisions`: by patch; `cuts`: the patches that loops cut; `stations`: for these
  /// divisions, or null. All must outlive this object.
  EdgeSegments(const PatchSet::Impl& set, const EdgeRuns& runs, std::span<const Division> divisions,
               std::span<const CutPatch> cuts, const EdgeStations* stations);

  /// Appends the segments of an edge: use by use, by growing parameters of the edge.
  void append(std::size_t edge, std::vector<EdgeSegment>& segments);
  /// Appends the segments of lines that close gaps between curves, after those of all edges. They have no parameters.
  void append_gaps(std::vector<EdgeSegment>& segments);
  /// Vertices that are one, in pairs: corners of a face's patches, ends of chords on lines between them, and the points
  /// of a side that is one point.
  std::span<const std::array<PatchVertex, 2>> same() const { return same_; }
  std::span<const InsertedVertex> inserted() const { return inserted_; }
  /// Inserts a vertex into a segment, at a parameter of the edge between its ends. Returns the vertex.
  PatchVertex insert(const EdgeSegment& segment, double s);
  const CutPatch* cut_of(std::uint32_t patch) const { return find_cut(cuts_, patch); }

 private:
  using Place = SideVertices::Place;
  void append_chords(const EdgeRun& run, std::vector<EdgeSegment>& segments);
  void append_side(const EdgeRun& run, std::vector<EdgeSegment>& segments);
  void append(const EdgeRun& run, std::vector<EdgeSegment>& segments) {
    run.is_side ? append_side(run, segments) : append_chords(run, segments);
  }
  /// Completes a segment between two parameters of the loop's curve.
  static void append(EdgeSegment segment, const CurveAlongEdge& curve, double from, double to,
                     std::vector<EdgeSegment>& segments);
  SideVertices vertices_of(std::uint32_t patch, Side side) const;
  /// Returns the vertex at a place from a to b; it is inserted if there is none.
  PatchVertex vertex_at(std::uint32_t patch, Side side, const Place& a, const Place& b, double along);
  PatchVertex insert_on_side(std::uint32_t patch, Side side, std::uint32_t start, std::uint32_t end, double along);
  std::optional<std::uint32_t> corner_vertex(std::uint32_t patch, bool end_u, bool end_v) const;
  /// Joins the vertices of a face's patches at a corner of them, if the point is one.
  void join_corner(const PatchEdges::Face& face, const ParameterPoint& at);
  /// Joins a vertex of a chord that lies on a side of its patch to those of the face's other patches there, of which
  /// there must be some.
  void join_across(const EdgeRun& run, const CutPatch& cut, std::uint32_t vertex);

  const PatchSet::Impl& set_;
  const EdgeRuns& runs_;
  std::span<const Division> divisions_;
  std::span<const CutPatch> cuts_;
  const EdgeStations* stations_;
  std::vector<InsertedVertex> inserted_;
  std::vector<std::array<PatchVertex, 2>> same_;
  std::unordered_multimap<std::uint64_t, std::uint32_t> on_sides_;  ///< vertices inserted where runs end on sides
};

}}  // namespace tessera::abi_0_1
