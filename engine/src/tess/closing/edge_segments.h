#pragma once
// The parts of a shape's edges that patches have on their boundaries: segments between vertices that follow each other.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <tuple>
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
  /// Equal for one vertex alone, and growing along each segment.
  auto place() const { return std::tuple(patch, start, end, at); }
};

/// Vertices that are inserted, in the order in which they were found to be missing.
struct InsertedVertices {
  std::vector<InsertedVertex> all;
  std::vector<std::uint32_t> on_sides;  ///< those where runs end on sides, by growing InsertedVertex::place()
};

/// A vertex of a patch: one that it has, or an index into the inserted ones.
struct PatchVertex {
  static constexpr std::uint32_t inserted = 0x80000000;  ///< a bit of `vertex`: the rest is an index into the list
  std::uint32_t patch = 0, vertex = 0;
  friend bool operator==(const PatchVertex&, const PatchVertex&) = default;
};

/// An end of segments: a vertex of a patch.
struct SegmentEnd {
  double s = 0;  ///< the edge's parameter
  PatchVertex vertex = {};
};

/// A part of a run, between vertices of a patch's boundary that follow each other.
struct EdgeSegment {
  const EdgeRun* run = nullptr;
  std::uint32_t low = 0, high = 0;   ///< into SegmentList::ends, by growing parameters of the edge
  std::uint32_t start = 0, end = 0;  ///< the boundary's own vertices; equal: a point, which gets no more vertices
  bool has_triangle = true;          ///< see CutPatch::LoopSegment
};

/// Segments, and their ends, of which those that follow each other share one.
struct SegmentList {
  std::vector<SegmentEnd> ends;
  std::vector<EdgeSegment> segments;

  const SegmentEnd& low(const EdgeSegment& of) const { return ends[of.low]; }
  const SegmentEnd& high(const EdgeSegment& of) const { return ends[of.high]; }
  /// Whether an end is the boundary's own vertex, so that each segment of a boundary counts once.
  bool begins(const EdgeSegment& of) const {
    return low(of).vertex.vertex == of.start || high(of).vertex.vertex == of.start;
  }
  void clear() { ends.clear(), segments.clear(); }
};

/// Finds the segments of edges, one edge after the other, and the vertices that they need where edges end. An object
/// serves one thread.
class EdgeSegments {
 public:
  /// `divisions`: by patch; `cuts`: the patches that loops cut; `stations`: for these divisions, or null. All must
  /// outlive this object.
  EdgeSegments(const PatchSet::Impl& set, const EdgeRuns& runs, std::span<const Division> divisions,
               std::span<const CutPatch> cuts, const EdgeStations* stations);

  /// Appends the segments of an edge: use by use, by growing parameters of the edge.
  void append(std::size_t edge, SegmentList& to);
  /// Appends the segments of lines that close gaps between curves. They have no parameters.
  void append_gaps(SegmentList& to);
  /// Inserts a vertex into a segment. `range`: the edge's parameters at the segment's ends; `s`: one between them.
  SegmentEnd insert(const EdgeSegment& segment, const Interval& range, double s);

  /// Vertices that are one, in pairs: corners of a face's patches, ends of chords on lines between them, and the points
  /// of a side that is one point.
  std::vector<std::array<PatchVertex, 2>>& same() { return same_; }
  /// The vertices that were inserted. Another object may have inserted the same ones where runs end on sides.
  InsertedVertices& inserted() { return inserted_; }

 private:
  using Place = SideVertices::Place;
  void append_chords(const EdgeRun& run, SegmentList& to);
  void append_side(const EdgeRun& run, SegmentList& to);
  void append_point(const EdgeRun& run, const SideVertices& side, SegmentList& to);
  /// Appends a side along all of which the run goes. `inside`: EdgeStations::at_vertices().
  void append_border(const EdgeRun& run, const SideVertices& side, std::span<const double> inside, SegmentList& to);
  void append(const EdgeRun& run, SegmentList& to) { run.is_side ? append_side(run, to) : append_chords(run, to); }
  /// Completes a segment between two ends in the order of the loop's curve.
  static void append(EdgeSegment segment, const std::array<std::uint32_t, 2>& ends, SegmentList& to) {
    const bool grows = to.ends[ends[0]].s <= to.ends[ends[1]].s;
    segment.low = ends[!grows], segment.high = ends[grows];
    to.segments.push_back(segment);
  }
  /// Returns the place of an end in the list, to which it is added unless it is the last one there.
  static std::uint32_t put(double s, const PatchVertex& vertex, SegmentList& to) {
    if (to.ends.empty() || to.ends.back().s != s || !(to.ends.back().vertex == vertex)) to.ends.push_back({s, vertex});
    return static_cast<std::uint32_t>(to.ends.size() - 1);
  }
  SideVertices vertices_of(std::uint32_t patch, Side side) const;
  const CutPatch* cut_of(std::uint32_t patch) const { return find_cut(cuts_, patch); }
  /// Returns the vertex at a place between a and b; it is inserted if there is none.
  PatchVertex vertex_between(std::uint32_t patch, Side side, const Place& a, const Place& b, double along);
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
  InsertedVertices inserted_;
  std::vector<std::array<PatchVertex, 2>> same_;
  const PatchEdges::Face* last_face_ = nullptr;  ///< whose corner was joined last
  ParameterPoint last_corner_ = {};
};

}}  // namespace tessera::abi_0_1
