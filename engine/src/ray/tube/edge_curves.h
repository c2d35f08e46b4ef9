#pragma once
// The curves that faces have along the edges of shapes, in the coordinates of a ray scene.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "ray/border/adjacency.h"
#include "ray/line/ray_line.h"
#include "ray/line/set_view.h"
#include "tess/closing/edge_runs.h"

namespace tessera { inline namespace abi_0_1 {

/// A point of a face's loop.
struct LoopPoint {
  std::uint32_t patch = 0;
  double u = 0, v = 0;  ///< in the patch
  Vec3 position;        ///< in the scene's coordinates
  double unsure = 0;    ///< how far the place of the loop is unsure, there
};
/// Returns the point at x, 0 to 1, of a piece of a loop that lies on a patch.
LoopPoint loop_point(const SetView& set, const SceneFrame& frame, const TrimPiece& piece, std::uint32_t patch,
                     double x);

/// A piece of a face's loop along an edge, on one patch; or a part of a line that closes a gap in the loop there.
struct EdgeStretch {
  const TrimPiece* piece = nullptr;
  CurveAlongEdge along;  ///< of a line: without an edge
  std::uint32_t patch = 0, face = 0;
  double from = 0, to = 0;    ///< the edge's parameters where the stretch starts and ends
  double begin = 0, end = 1;  ///< the places on the piece, 0 to 1, there
  double low() const { return std::min(from, to); }
  double high() const { return std::max(from, to); }
  /// Returns the place on the piece after a share, 0 to 1, of the stretch.
  double place(double share) const { return (1 - share) * begin + share * end; }
  ParameterPoint first_point() const { return begin < end ? piece->start() : piece->end(); }
  ParameterPoint last_point() const { return begin < end ? piece->end() : piece->start(); }
  ParameterPoint low_point() const { return from <= to ? first_point() : last_point(); }
  ParameterPoint high_point() const { return from <= to ? last_point() : first_point(); }
  bool is_line() const { return along.coedge == nullptr; }
};

/// The curve of one face along an edge: stretches by growing parameters of the edge.
///
/// A curve of a loop that leaves its surface's domain is cut off there, and lines along the domain's border close the
/// gap. They are stretches of the curve as well. A line from one edge to the next, around a vertex, is divided at its
/// point nearest to the vertex.
using EdgeCurve = std::vector<EdgeStretch>;

/// Whether two parameters of an edge are one.
bool is_same(const PatchEdges::Edge& edge, double a, double b);

/// A line of a face's boundary that belongs to no curve: it lies at a vertex.
struct VertexLine {
  std::uint32_t vertex = 0, patch = 0;
  const TrimPiece* piece = nullptr;
};

/// Lists the curves along edges. It refers to the set.
class EdgeCurves {
 public:
  EdgeCurves(const SetView& set, const SceneFrame& frame);

  std::size_t edge_count() const { return edges_->edges.size(); }
  const PatchEdges::Edge& edge(std::size_t k) const { return edges_->edges[k]; }
  std::size_t vertex_count() const { return edges_->vertices.size(); }
  /// Returns the curves of an edge, the longest first.
  std::vector<EdgeCurve> of(std::size_t edge) const;
  /// Whether more than one curve runs along an edge.
  bool meet(std::size_t edge) const { return runs_.meet(edge); }
  /// Whether all patches along an edge are whole, and joined by equal control points of their borders: then their roots
  /// there are told apart by identity (see distinct_roots.h).
  bool is_joined(std::size_t edge, const Adjacency& adjacency) const;
  /// Whether one of the edge's patches has its mark.
  bool has_marked(std::size_t edge, const std::vector<bool>& marks) const;
  /// Returns the point of a stretch at a parameter of the edge within it.
  LoopPoint at(const EdgeStretch& stretch, double s) const;
  /// Returns the point at a place x, begin to end, of a stretch.
  LoopPoint at_place(const EdgeStretch& stretch, double x) const {
    return loop_point(*set_, frame_, *stretch.piece, stretch.patch, x);
  }
  /// Returns the edge's parameter at a place x of a stretch.
  double parameter(const EdgeStretch& stretch, double x) const;
  /// Returns the point of a curve at a parameter of the edge, or at its nearest end.
  LoopPoint at(const EdgeCurve& curve, double s) const;
  /// Returns the stretch of a curve that has a parameter of the edge; null if the curve has a gap there.
  static const EdgeStretch* stretch_at(const EdgeCurve& curve, const PatchEdges::Edge& edge, double s);
  /// Lists the lines that close gaps between the curves of loops.
  std::vector<VertexLine> vertex_lines() const;

 private:
  /// Lines that follow each other and close one gap of a face's loop, as stretches without parameters.
  using Bridge = std::vector<EdgeStretch>;

  void find_bridges();
  static Bridge turned(Bridge bridge);
  std::vector<const TrimPiece*> touching(std::uint32_t face, const ParameterPoint& point) const;
  /// Returns the edge's vertex where a piece along it starts or ends; no_id if that is elsewhere.
  std::uint32_t vertex_at(std::uint32_t face, const TrimPiece& piece, bool at_end) const;
  Bridge bridge(std::uint32_t face, const ParameterPoint& from, const ParameterPoint* to) const;
  void close_gaps(const PatchEdges::Edge& edge, std::span<EdgeCurve> curves) const;
  void add_bridge(Bridge bridge, double from, double to, EdgeCurve& curve) const;
  Bridge up_to(Bridge bridge, const Vec3& vertex) const;
  std::optional<Vec3> end_of(const PatchEdges::Edge& edge, std::span<const EdgeCurve> curves, double s) const;

  const SetView* set_;
  SceneFrame frame_;
  EdgeRuns runs_;
  const PatchEdges* edges_;
  std::vector<Bridge> bridges_;  ///< by growing faces
};

}}  // namespace tessera::abi_0_1
