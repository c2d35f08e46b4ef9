#pragma once
// The curves that faces have along the edges of shapes, in the coordinates of a ray scene.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "ray/line/ray_line.h"
#include "ray/line/set_view.h"
#include "ray/seam/adjacency.h"
#include "tess/closing/edge_runs.h"

namespace tessera::inline abi_0_1 {

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

/// A piece of a face's loop along an edge, on one patch.
struct EdgeStretch {
  const TrimPiece* piece = nullptr;
  CurveAlongEdge along;
  std::uint32_t patch = 0;
  double from = 0, to = 0;  ///< the edge's parameters where the piece starts and ends
  double low() const { return std::min(from, to); }
  double high() const { return std::max(from, to); }
};

/// The curve of one face along an edge: stretches by growing parameters of the edge.
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
  EdgeCurves(const SetView& set, const SceneFrame& frame)
      : set_(&set), frame_(frame), runs_(set.impl()), edges_(set.impl().edges.get()) {}

  std::size_t edge_count() const { return edges_->edges.size(); }
  const PatchEdges::Edge& edge(std::size_t k) const { return edges_->edges[k]; }
  std::size_t vertex_count() const { return edges_->vertex_count; }
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
  LoopPoint at_place(const EdgeStretch& stretch, double x) const {
    return loop_point(*set_, frame_, *stretch.piece, stretch.patch, x);
  }
  /// Returns the edge's parameter at a place x of a stretch.
  double parameter(const EdgeStretch& stretch, double x) const;
  /// Returns the point of a curve at a parameter of the edge, or at its nearest end.
  LoopPoint at(const EdgeCurve& curve, double s) const;
  /// Lists the lines that close gaps between the curves of loops.
  std::vector<VertexLine> vertex_lines() const;

 private:
  const SetView* set_;
  SceneFrame frame_;
  EdgeRuns runs_;
  const PatchEdges* edges_;
};

}  // namespace tessera::inline abi_0_1
