#pragma once
// One patch of a trimmed face: its polygon, its triangles and their bound.

#include <array>
#include <atomic>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "base/function_ref.h"
#include "plane/chord_crossings.h"
#include "plane/cut_cells.h"
#include "tess/cells/patch_side.h"
#include "tess/trimmed/patch_stations.h"
#include "tess/trimmed/piece_chords.h"
#include "tess/trimmed/speed_bound.h"
#include "tess/trimmed/vertex_merger.h"
#include "tessera/geometry.h"
#include "trim/trim_piece.h"

namespace tessera { inline namespace abi_0_1 {

/// The facts that cutting a patch needs.
struct TrimmedPatch {
  Domain domain;           ///< in the surface's parameters, as those of loops and of cells
  SpeedBound speed;        ///< over the patch's own parameters
  PatchSegments segments;  ///< of its grid
  double sliver;           ///< the largest distance between chords and curves
  double room;             ///< the largest distance of a triangle, with that of the slivers; infinite: no limit
  bool in_cells;           ///< whether triangles must be no wider than cells
  double bend;             ///< see ChordLimits
  VertexRounding rounding;
  std::array<bool, 4> is_shared{};          ///< by Side: whether another patch has the same border, as across a seam
  const PatchStations* stations = nullptr;  ///< set if loops name edges of a shape
  double chord_share = 1;                   ///< the largest length of a chord, in cells
  std::uint64_t max_triangles = std::numeric_limits<std::uint64_t>::max();
  const std::atomic<bool>* cancel = nullptr;
};

/// The limits of chords in a patch.
ChordLimits chord_limits(const TrimmedPatch& patch);

/// A chord of a piece of a loop, between two points of the polygon. A part of a chord that crosses others has the
/// parameters of its nearest ends along the curve.
struct LoopChord {
  std::uint32_t piece = 0;  ///< the first that it spans
  std::uint32_t start = 0, end = 0;
  double from = 0, to = 0;  ///< the parameters of the caller's curve
};

/// Cuts patches, one after the other.
class PatchCutter {
 public:
  /// Begins a polygon.
  void begin(const TrimmedPatch& patch);
  /// Adds the kept parts of a side, by its points. Returns the number of chords.
  std::size_t add_side(std::span<const SidePoint> points, Side side);
  /// Adds the pieces of loops with these indices, in the order of the loops. Returns the number of chords that are no
  /// points.
  std::size_t add_pieces(std::span<const TrimPiece> pieces, std::span<const std::uint32_t> indices);
  /// Triangulates the polygon. Returns false if chords cross.
  bool cut();
  /// Divides chords where they cross, and triangulates the polygon. Returns false if some still cross.
  bool cut_crossing();

  CutCells& cells() { return cells_; }
  /// Calls visit(LoopChord) for the chords of pieces, in their order. Points that are equal count as the first of them.
  template <class Visit>
  void for_loop_chords(Visit visit) const {
    for (std::size_t k = 0; k < chords_.size(); ++k) {
      if (marks_[k] == no_id) continue;
      const auto [start, end] = chords_[k];
      if (points_[start] == points_[end]) continue;
      const LoopChord& whole = loop_chords_[marks_[k]];
      visit(LoopChord{whole.piece, cells_.first_equal(start), cells_.first_equal(end), parameter(whole, start),
                      parameter(whole, end)});
    }
  }
  /// Returns the parameter of the caller's curve at a point on a chord.
  double parameter(const LoopChord& chord, std::uint32_t point) const;
  bool has_divided_chords() const { return cells_.has_divided_chords(); }
  /// The parameters of a vertex, in the surface and in the patch.
  ParameterPoint point(std::uint32_t vertex) const;
  ParameterPoint local(std::uint32_t vertex) const;
  std::size_t vertex_count() const { return points_.size() + cells_.grid_vertices().size(); }
  /// The vertices up to this one are points of loops and sides, the others those of the grid.
  std::size_t loop_vertex_count() const { return points_.size(); }
  /// The largest distance of a sliver, in the patch's lengths.
  double sliver_bound() const { return sliver_; }

 private:
  std::uint32_t add_point(const ParameterPoint& point);
  /// Adds the points of a chain but its start, and their parameters. `first`: its first piece. Returns the sliver.
  double add_chords(std::span<const TrimPiece> chain, std::uint32_t first);
  /// Whether a piece continues a chain of pieces from `start` to the end of `before` so that it stays monotone.
  bool continues(const ParameterPoint& start, const TrimPiece& before, const TrimPiece& next) const;

  TrimmedPatch patch_;
  ChordLimits limits_;
  PieceChords chords_of_pieces_;
  ChordCrossings crossings_;
  CutCells cells_;
  std::vector<ParameterPoint> points_;
  std::vector<PlaneSegment> chords_;
  std::vector<LoopChord> loop_chords_;
  std::vector<std::uint32_t> marks_;  ///< by chord: its place in loop_chords_, or no_id on a side
  std::vector<double> parameters_;    ///< of the points of one chain
  std::vector<double> lines_u_, lines_v_;
  GridLines grid_;
  double sliver_ = 0;
};

}}  // namespace tessera::abi_0_1
