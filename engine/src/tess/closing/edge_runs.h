#pragma once
// The runs of faces' loops along the edges of shapes, patch by patch.

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "base/internal_export.h"
#include "block/patch_edges.h"
#include "block/patch_set_impl.h"
#include "model/coedge_parameter.h"
#include "tess/cells/patch_side.h"
#include "trim/trim_piece.h"

namespace tessera { inline namespace abi_0_1 {

struct FaceSides;

/// Pieces of a loop that follow each other along one edge and within one patch: along one of its sides, or through its
/// inside.
struct EdgeRun {
  std::uint32_t edge = no_id;        ///< into PatchEdges::edges; no_id: none, so the pieces close a gap
  std::uint32_t use = 0;             ///< a number of the coedge, in the order of faces, loops and curves
  std::uint32_t face = 0;            ///< into PatchEdges::faces
  std::uint32_t first = 0, end = 0;  ///< into the pieces of the face's region
  std::uint32_t patch = 0;
  bool is_side = false;
  Side side{};  ///< if it runs along one
};

/// A curve of a face's loop, and the use of an edge that it has. A curve without an edge has neither.
struct CurveAlongEdge {
  const Coedge* coedge = nullptr;
  const Curve* curve = nullptr;
  /// The edge's parameter at one of the curve, and the other way round, if there is an edge.
  double to_edge(double t) const { return edge_parameter(*coedge, *curve, t); }
  double to_curve(double s) const { return curve_parameter(*coedge, *curve, s); }
};

/// Bounds on the share of an edge's range within which two parameters count as one. Faces of one edge rarely have equal
/// parameters at one place; a vertex moves by as much along the edge.
inline constexpr double least_same_share = 1e-9, largest_same_share = 1e-5;
/// Returns that share for a tolerance. An edge is rarely longer than a few diagonals of the set, so vertices move by a
/// small part of the tolerance.
double same_share(const PatchSet::Impl& set, double tolerance);

/// All runs of a set, edge by edge. They depend on the set's loops alone.
class EdgeRuns {
 public:
  /// The set must have edges, and must outlive the runs. Faces are shared among the threads of the caller's arena.
  TESSERA_INTERNAL_EXPORT explicit EdgeRuns(const PatchSet::Impl& set);

  /// The runs of an edge: use by use, and along each in the direction of its curve.
  std::span<const EdgeRun> of(std::size_t edge) const {
    return std::span(runs_).subspan(first_[edge], first_[edge + 1] - first_[edge]);
  }
  /// The runs of lines that close gaps between the curves of loops.
  std::span<const EdgeRun> gaps() const { return gaps_; }
  /// Whether faces meet along an edge, or a face meets itself.
  bool meet(std::size_t edge) const { return !of(edge).empty() && of(edge).front().use != of(edge).back().use; }
  /// `[4 * patch + side]`: 1 for borders along such edges.
  std::vector<std::uint8_t> borders_that_meet(std::size_t patches) const;
  /// Pairs of borders, 4 * patch + side, along one edge whose points at equal shares lie at equal parameters of the
  /// edge. So they meet without further vertices if they have as many segments.
  std::vector<std::array<std::uint32_t, 2>> borders_in_step(const PatchSet::Impl& set) const;
  /// The number of a run, below count().
  std::size_t index(const EdgeRun& run) const { return static_cast<std::size_t>(&run - runs_.data()); }
  std::size_t count() const { return runs_.size(); }
  /// Calls visit(run) for the runs within a patch and along its sides.
  template <class Visit>
  void for_runs_of(std::uint32_t patch, Visit visit) const {
    const auto key = [&](std::uint32_t k) { return runs_[k].patch; };
    for (const std::uint32_t k : std::ranges::equal_range(by_patch_, patch, {}, key)) visit(runs_[k]);
  }
  TESSERA_INTERNAL_EXPORT std::span<const TrimPiece> pieces(const EdgeRun& run) const;
  /// The curve of a piece's loop, and the edge along it.
  TESSERA_INTERNAL_EXPORT CurveAlongEdge curve(std::uint32_t face, const TrimPiece& piece) const;
  CurveAlongEdge curve(const EdgeRun& run) const { return curve(run.face, pieces(run).front()); }
  const PatchEdges& edges() const { return *edges_; }

 private:
  /// The runs of some faces that follow each other.
  struct Runs {
    std::vector<EdgeRun> along_edges, gaps;
  };
  /// Adds the runs of a face. `use`: the number of its first coedge.
  void add_face(const PatchSet::Impl& set, std::uint32_t face, std::uint32_t use, Runs& to) const;
  /// Finds the patch and the side of a run along a line between patches. `low`: the side along
  /// that line of the patch above it; `sides`: those of the face, once they are known.
  void find_side(EdgeRun& run, Side low, std::optional<FaceSides>& sides) const;
  void sort();

  const PatchEdges* edges_;
  std::vector<EdgeRun> runs_, gaps_;
  std::vector<std::uint32_t> first_;     ///< by edge
  std::vector<std::uint32_t> by_patch_;  ///< runs by growing patch
};

/// Returns the places along a side at which pieces that follow each other begin and end, the lesser one first.
inline std::pair<double, double> ends_along(Side side, std::span<const TrimPiece> pieces) {
  return std::minmax({along_side(side, pieces.front().start()), along_side(side, pieces.back().end())});
}
/// Returns the parameter of the caller's curve where pieces that follow each other have a place along a side.
double parameter_at(std::span<const TrimPiece> pieces, Side side, double place);
/// Returns the point of pieces that follow each other at a parameter of the caller's curve, within the piece's box.
ParameterPoint point_at(std::span<const TrimPiece> pieces, double t);

}}  // namespace tessera::abi_0_1
